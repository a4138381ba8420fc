#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/channels.hpp"
#include "common/transport.hpp"

namespace hairpin {

/// One daemon's place on the transport: typed subscriptions and publications, with everything that
/// is wrong on the wire counted and dropped before a handler sees it.
///
/// Dropped are payloads that do not decode exactly (type, lengths, trailing bytes, NaN), duplicates
/// by (boot id, sequence), and times that cannot be (more than 10 s ahead of all others, unless the
/// channel insists). Messages out of order pass: what to do with them is the node's.
class Bus {
 public:
  /// `boot_id` names this run of the daemon on every message it sends; it must differ between runs
  /// on a shared network.
  Bus(Transport& transport, std::string daemon, int64_t boot_id);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Calls `handler(const M&)` for each good message, in the order of arrival.
  template <class M, class Handler>
  void Subscribe(const Channel<M>& channel, Handler handler);

  /// Fills in boot id and sequence, and sends.
  template <class M>
  void Publish(const Channel<M>& channel, M message);

  /// Counts a message that decoded but was refused by the node, and warns on stderr at most once a
  /// second of data time.
  template <class M>
  void Refuse(const Channel<M>& channel, const std::string& why) {
    Refuse(std::string(channel.name), why);
  }

  /// An input that is no channel, such as a socket: its counters, the caller's to keep, are
  /// reported in Health() beside the channels'. Throws std::logic_error for a name that is taken.
  channel_health_t& AddInput(const std::string& name);
  /// Says on stderr what was wrong on such an input, at most once a second of data time.
  void WarnOfInput(const std::string& name, const std::string& why);
  /// For a driver, whose measurements are the data: `utime` is when the newest was taken.
  void AdvanceDataTime(int64_t utime);

  /// Calls `listener(utime)` whenever a handled message, or the node, has advanced the data
  /// time; after the message's own handler.
  void OnDataTime(std::function<void(int64_t)> listener) {
    data_time_listener_ = std::move(listener);
  }

  /// Newest utime heard on any channel; 0 before the first.
  int64_t newest_utime() const { return newest_utime_; }
  const std::string& daemon() const { return daemon_; }
  int64_t boot_id() const { return boot_id_; }
  /// Of the transport.
  const std::string& url() const { return transport_.url(); }
  /// What was heard on each subscribed channel.
  std::vector<channel_health_t> Health() const;

 private:
  /// Duplicates and gaps of one sender, by a sliding window over its sequence.
  struct Sender {
    int64_t boot_id;
    int64_t highest;
    uint64_t seen;  // bit i: highest - i was received
    int too_old_in_a_row = 0;
  };
  struct Subscription {
    channel_health_t health{};
    std::deque<Sender> senders;  // bounded by kMaxSenders, oldest first
    int64_t last_warning_utime = 0;
    int implausible_in_a_row = 0;
    int64_t implausible_utime = 0;
    std::shared_ptr<Transport::RawSubscription> raw;
  };

  static bool HasFingerprint(const uint8_t* data, size_t size, int64_t fingerprint);
  std::string PayloadProblem(const std::string& type, const uint8_t* data, size_t size,
                             int64_t fingerprint) const;
  bool IsDuplicate(Subscription& subscription, int64_t boot_id, int64_t sequence);
  bool IsPlausible(Subscription& subscription, int64_t utime);
  bool Accept(Subscription& subscription, int64_t utime, int64_t boot_id, int64_t sequence);
  void CountUndecodable(Subscription& subscription, const std::string& why);
  void Refuse(const std::string& channel, const std::string& why);
  void Warn(Subscription& subscription, const std::string& why);

  Transport& transport_;
  std::string daemon_;
  int64_t boot_id_;
  int64_t newest_utime_ = 0;
  std::map<std::string, std::unique_ptr<Subscription>> subscriptions_;
  std::map<std::string, int32_t> sequences_;
  std::function<void(int64_t)> data_time_listener_;
};

template <class M, class Handler>
void Bus::Subscribe(const Channel<M>& channel, Handler handler) {
  auto& slot = subscriptions_[channel.name];
  if (slot) throw std::logic_error(daemon_ + " subscribes twice to " + channel.name);
  slot = std::make_unique<Subscription>();
  Subscription& subscription = *slot;
  subscription.health.channel = channel.name;
  const std::string type = M::getTypeName();
  subscription.raw = transport_.Subscribe(
      channel.name,
      [this, &subscription, type, handler](const std::string&, const uint8_t* data, size_t size) {
        const std::string problem = PayloadProblem(type, data, size, M::getHash());
        if (!problem.empty()) return CountUndecodable(subscription, problem);
        M message{};
        if (message.decode(data, 0, static_cast<int>(size)) != static_cast<int>(size)) {
          return CountUndecodable(subscription, "does not decode");
        }
        if (!Accept(subscription, message.utime, message.boot_id, message.sequence)) return;
        handler(static_cast<const M&>(message));
        AdvanceDataTime(message.utime);
      });
}

template <class M>
void Bus::Publish(const Channel<M>& channel, M message) {
  message.boot_id = boot_id_;
  message.sequence = sequences_[channel.name]++;
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  transport_.Publish(channel.name, bytes.data(), bytes.size());
}

}  // namespace hairpin
