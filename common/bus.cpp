#include "common/bus.hpp"

#include <algorithm>
#include <iostream>

#include "common/clock.hpp"
#include "common/wire_schema.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxSenders =
    64;                      // on one channel; every daemon sends HEARTBEAT, and may have restarted
constexpr int kWindow = 64;  // messages that may arrive out of order
// A time this far ahead of everything heard is a broken clock, unless the channel insists on it:
// then a replay has begun anew, or the machine has slept.
constexpr double kMaxJump = 10.0;  // s
constexpr int kMessagesToInsist = 20;
// 2100-01-01. No clock of a car shows more, and far beyond it arithmetic on times would overflow.
constexpr int64_t kMaxUtime = 4'102'444'800'000'000;

}  // namespace

Bus::Bus(Transport& transport, std::string daemon, int64_t boot_id)
    : transport_(transport), daemon_(std::move(daemon)), boot_id_(boot_id) {}

Bus::~Bus() = default;

std::string Bus::PayloadProblem(const std::string& type, const uint8_t* data, size_t size,
                                int64_t fingerprint) const {
  if (!HasFingerprint(data, size, fingerprint)) return "is no " + type;
  return WireSchema::Hairpin().Problem(type, data + sizeof(int64_t), size - sizeof(int64_t));
}

bool Bus::HasFingerprint(const uint8_t* data, size_t size, int64_t fingerprint) {
  if (size < sizeof(int64_t)) return false;
  uint64_t word = 0;
  for (size_t i = 0; i < sizeof(int64_t); ++i) word = word << 8 | data[i];
  return word == static_cast<uint64_t>(fingerprint);
}

bool Bus::Accept(Subscription& subscription, int64_t utime, int64_t boot_id, int64_t sequence) {
  if (!IsPlausible(subscription, utime)) {
    ++subscription.health.implausible_time;
    Warn(subscription, "dropped: time " + std::to_string(utime) + " cannot be");
    return false;
  }
  if (IsDuplicate(subscription, boot_id, sequence)) {
    ++subscription.health.duplicates;
    return false;
  }
  ++subscription.health.received;
  return true;
}

bool Bus::IsPlausible(Subscription& subscription, int64_t utime) {
  if (utime < 0 || utime > kMaxUtime) return false;
  // 0 is a heartbeat that has heard nothing yet; far in the past is merely late, and the node's to
  // judge.
  if (newest_utime_ == 0 || utime == 0 || SecondsBetween(newest_utime_, utime) <= kMaxJump) {
    subscription.implausible_in_a_row = 0;
    return true;
  }
  const double step = SecondsBetween(subscription.implausible_utime, utime);
  const bool goes_on = subscription.implausible_in_a_row > 0 && step >= 0.0 && step <= kMaxJump;
  subscription.implausible_in_a_row = goes_on ? subscription.implausible_in_a_row + 1 : 1;
  subscription.implausible_utime = utime;
  return subscription.implausible_in_a_row > kMessagesToInsist;
}

bool Bus::IsDuplicate(Subscription& subscription, int64_t boot_id, int64_t sequence) {
  auto& senders = subscription.senders;
  auto sender = std::find_if(senders.begin(), senders.end(),
                             [boot_id](const Sender& s) { return s.boot_id == boot_id; });
  if (sender == senders.end()) {
    if (senders.size() == kMaxSenders) senders.pop_front();
    senders.push_back({boot_id, sequence, 1});
    ++subscription.health.senders;
    return false;
  }
  const int64_t ahead = sequence - sender->highest;
  if (ahead > -kWindow) sender->too_old_in_a_row = 0;
  if (ahead > 0) {
    sender->seen = ahead < kWindow ? sender->seen << ahead | 1u : 1u;
    sender->highest = sequence;
    subscription.health.missing += ahead - 1;
    return false;
  }
  if (ahead <= -kWindow) {
    // Too old to tell: as good as a duplicate. Unless the sender insists: then one corrupt sequence
    // made all others look old, and would silence it for ever.
    if (++sender->too_old_in_a_row <= kMessagesToInsist) return true;
    *sender = {boot_id, sequence, 1};
    return false;
  }
  const uint64_t bit = uint64_t{1} << -ahead;
  if ((sender->seen & bit) != 0) return true;
  sender->seen |= bit;
  --subscription.health.missing;  // a gap that has filled late
  return false;
}

void Bus::CountUndecodable(Subscription& subscription, const std::string& why) {
  ++subscription.health.undecodable;
  Warn(subscription, "dropped: " + why);
}

void Bus::Refuse(const std::string& channel, const std::string& why) {
  const auto found = subscriptions_.find(channel);
  if (found == subscriptions_.end())
    throw std::logic_error(daemon_ + " refuses a message of " + channel + ", not subscribed");
  ++found->second->health.refused;
  Warn(*found->second, "dropped: " + why);
}

channel_health_t& Bus::AddInput(const std::string& name) {
  auto& slot = subscriptions_[name];
  if (slot) throw std::logic_error(daemon_ + " has two inputs called " + name);
  slot = std::make_unique<Subscription>();
  slot->health.channel = name;
  return slot->health;
}

void Bus::WarnOfInput(const std::string& name, const std::string& why) {
  Warn(*subscriptions_.at(name), why);
}

void Bus::Warn(Subscription& subscription, const std::string& why) {
  const bool first = subscription.last_warning_utime == 0;
  if (!first && SecondsBetween(subscription.last_warning_utime, newest_utime_) < 1.0) return;
  subscription.last_warning_utime = std::max<int64_t>(newest_utime_, 1);
  std::cerr << daemon_ << ": " << subscription.health.channel << ": " << why << '\n';
}

void Bus::AdvanceDataTime(int64_t utime) {
  if (utime <= newest_utime_) return;
  newest_utime_ = utime;
  if (data_time_listener_) data_time_listener_(utime);
}

std::vector<channel_health_t> Bus::Health() const {
  std::vector<channel_health_t> health;
  for (const auto& [name, subscription] : subscriptions_) health.push_back(subscription->health);
  return health;
}

}  // namespace hairpin
