#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "common/errors.hpp"

namespace hairpin {

/// The commit this was built from, with "-dirty" where tracked files differed from it; "unknown"
/// outside a git checkout.
const char* BuildId();

/// A node of any class, kept alive with its subscriptions. What RunDaemon() runs in a process of
/// its own, and the simulator's in-process mode next to all others.
class HostedNode {
 public:
  virtual ~HostedNode() = default;
  /// Calls the node's `Poll()`, if it has one: work that no message causes, such as noticing that
  /// none come.
  virtual void Poll() {}
  virtual bool has_poll() const { return false; }
  /// What the node's `descriptors()` says, if it has one: sockets and ports that it reads from in
  /// `Poll()`, which is then called as soon as one is readable. May change between calls.
  virtual std::vector<int> descriptors() const { return {}; }
};

using NodeFactory = std::function<std::unique_ptr<HostedNode>(Bus&, const Config&)>;

/// Wraps a function `Node make(Bus&, const Config&)`. Nodes need neither copy nor move.
template <class Make>
NodeFactory Host(Make make) {
  using Node = std::invoke_result_t<Make, Bus&, const Config&>;
  class Hosted final : public HostedNode {
   public:
    Hosted(const Make& make_node, Bus& bus, const Config& config) : node_(make_node(bus, config)) {}
    void Poll() override {
      if constexpr (requires(Node & node) { node.Poll(); }) node_.Poll();
    }
    bool has_poll() const override {
      return requires(Node & node) { node.Poll(); };
    }
    std::vector<int> descriptors() const override {
      if constexpr (requires(const Node& node) { node.descriptors(); }) return node_.descriptors();
      return {};
    }

   private:
    Node node_;
  };
  return [make](Bus& bus, const Config& config) {
    return std::make_unique<Hosted>(make, bus, config);
  };
}

/// Sends HEARTBEAT each 100 ms of data time. Listens to `bus`'s data time, which it must outlive or
/// be destroyed with.
class Heartbeat {
 public:
  /// `car_hash`: Config::SiblingHash("car").
  Heartbeat(Bus& bus, int64_t car_hash);
  /// For when nothing is heard: sends one now.
  void Send();

 private:
  void OnDataTime(int64_t utime);
  Bus& bus_;
  int64_t car_hash_;
  int64_t last_sent_utime_ = 0;
};

/// An option of the command line that only one daemon has.
struct DaemonOption {
  std::string name;  // "--pcap"
  std::string help;
  std::string* value;  // is set before the node is made
};

/// What is to be known of a daemon before its command line is read.
struct DaemonSpec {
  std::string name;  // of its folder, its config file
  /// For a daemon that runs several times on one car: `--instance` must give one of these, and
  /// NAME_INSTANCE is what it is called on the bus (Bus::daemon()).
  std::vector<std::string> instances{};
  std::vector<DaemonOption> options{};
};

/// The whole life of a daemon: arguments (--help), signals, config, bus, node, heartbeat, sd_notify
/// from the work loop. Returns the exit code: 0 after SIGINT or SIGTERM, 1 cannot run, 2 wrong
/// usage, 78 bad config.
int RunHosted(const DaemonSpec& spec, int argc, char** argv, const NodeFactory& factory);

template <class Make>
int RunDaemon(const DaemonSpec& spec, int argc, char** argv, Make make) {
  return RunHosted(spec, argc, argv, Host(make));
}

template <class Make>
int RunDaemon(const std::string& name, int argc, char** argv, Make make) {
  return RunDaemon(DaemonSpec{name}, argc, argv, make);
}

}  // namespace hairpin
