#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/can/memory_can_bus.hpp"
#include "common/clock.hpp"
#include "common/daemon.hpp"

namespace hairpin {

class GnssDriverNode;
class LidarDriverNode;
class PacketSender;
class PseudoTerminal;

/// Where the simulator enters the stack: messages and cones, as drivers and pipelines report them,
/// or the sensors' own protocols: CAN, the receiver's serial port, the LiDARs' packets.
enum class SensorLevel { kCones, kRaw };

/// What the simulator is called on its messages; daemons in its process have others.
inline constexpr int64_t kSimulatorBootId = 1;

/// The daemons that make the car drive, in the order of the data's flow, as they are called on the
/// bus.
const std::vector<std::string>& StackDaemons(SensorLevel level);

/// What runs under a daemon's name on the bus: "lidar_driver_front" is `lidar_driver` with
/// `--instance front`.
struct DaemonProgram {
  std::string program;
  std::string instance;  // empty where the daemon runs once
};
DaemonProgram ProgramOf(const std::string& daemon);

struct StackOptions {
  std::string config_dir;
  std::string program_dir;  // where the daemons' executables lie
  std::string log_dir;      // for what they write to stderr
  /// "daemon.key=value" in place of what the daemon's config file says.
  std::vector<std::string> overrides;
  SensorLevel level = SensorLevel::kCones;
  /// Daemons besides those: the drivers of what the simulator sends by the sensors' own protocols.
  std::vector<std::string> drivers{};
  /// The bus of can_gateway where all run in one process; must outlive the stack.
  MemoryCanBus* can_bus = nullptr;
};

/// StackDaemons() and the drivers.
std::vector<std::string> DaemonsOf(const StackOptions& options);

/// The daemons as a whole, whichever way they run.
class Stack {
 public:
  virtual ~Stack() = default;
  /// Kills (off) or starts (on) one daemon.
  virtual void SetDaemon(const std::string& name, bool on) = 0;
  /// Lets the daemons do what is to be done at simulated time `utime`; restarts what has died
  /// unasked.
  virtual void Tend(int64_t utime) = 0;
  /// A LiDAR sends a packet at `utime`; `sensor` as LidarRig calls it, `position` where it is no
  /// data packet. Dropped where nobody listens.
  virtual void SendPacket(const std::string& sensor, bool position, std::span<const uint8_t> packet,
                          int64_t utime) = 0;
  /// The GNSS receiver says something on its serial port. Dropped where nobody listens.
  virtual void SendGnss(std::span<const uint8_t> bytes) = 0;
};

/// Driver nodes that run in this process without their sockets and ports.
struct Drivers {
  std::map<std::string, LidarDriverNode*> lidars;  // by sensor
  GnssDriverNode* gnss = nullptr;
};

/// All nodes in this process, on one shared transport. What a node throws comes out of the
/// transport's Handle().
class InProcessStack final : public Stack {
 public:
  /// Throws ConfigError, its lines prefixed with the daemon's name.
  InProcessStack(const StackOptions& options, Transport& transport);
  void SetDaemon(const std::string& name, bool on) override;
  void Tend(int64_t utime) override;
  /// Hands it to the driver's node, as its socket would.
  void SendPacket(const std::string& sensor, bool position, std::span<const uint8_t> packet,
                  int64_t utime) override;
  void SendGnss(std::span<const uint8_t> bytes) override;

 private:
  struct Member {
    std::unique_ptr<Bus> bus;
    std::unique_ptr<Heartbeat> heartbeat;
    std::unique_ptr<HostedNode> node;
  };
  StackOptions options_;
  Transport& transport_;
  ManualClock clock_;
  Drivers drivers_;
  std::map<std::string, NodeFactory> factories_;
  std::map<std::string, Member> members_;
  int64_t starts_ = kSimulatorBootId;
};

/// Daemons that somebody else has started and looks after: systemd on the car, or in a container.
class AttachedStack final : public Stack {
 public:
  /// Throws std::logic_error: they are not ours to switch.
  void SetDaemon(const std::string& name, bool on) override;
  void Tend(int64_t) override {}
  void SendPacket(const std::string&, bool, std::span<const uint8_t>, int64_t) override {}
  void SendGnss(std::span<const uint8_t>) override {}
};

/// Every daemon a process of its own, as on the car. A daemon that dies unasked is started again
/// after 100 ms, five times in ten seconds at most, as its systemd unit would. All are ended with
/// this object.
class ProcessStack final : public Stack {
 public:
  ProcessStack(const StackOptions& options, const std::string& lcm_url);
  ~ProcessStack() override;
  void SetDaemon(const std::string& name, bool on) override;
  /// Throws std::runtime_error, with the last lines that the daemon wrote, where one cannot be kept
  /// alive.
  void Tend(int64_t utime) override;
  /// Over UDP on loopback, to the ports of lidar_driver.yaml.
  void SendPacket(const std::string& sensor, bool position, std::span<const uint8_t> packet,
                  int64_t utime) override;
  /// Over the pseudo terminal that is gnss_driver's port.
  void SendGnss(std::span<const uint8_t> bytes) override;

 private:
  struct Process {
    int pid = 0;  // 0: not running
    bool wanted = true;
    int64_t restart_at = 0;         // wall time, us
    std::vector<int64_t> restarts;  // wall times of the last ten seconds
  };
  void Start(const std::string& name, Process& process);
  void Reap(const std::string& name, Process& process);
  std::string LogFile(const std::string& name) const;
  [[noreturn]] void GiveUp(const std::string& name, const std::string& why) const;

  StackOptions options_;
  std::string lcm_url_;
  MonotonicClock clock_;
  std::unique_ptr<PacketSender> sender_;       // none at the level of cones
  std::unique_ptr<PseudoTerminal> gnss_port_;  // the same
  std::map<std::string, Process> processes_;
};

}  // namespace hairpin
