#include "daemons/lidar_driver/sensor_clock.hpp"

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr int64_t kHour = 3'600'000'000;  // us

// `difference` modulo an hour, the one nearest to 0.
int64_t WrapHour(int64_t difference) {
  const int64_t positive = (difference % kHour + kHour) % kHour;
  return positive >= kHour / 2 ? positive - kHour : positive;
}

}  // namespace

int64_t SensorClock::Unwrapped(uint32_t time_us) const {
  const auto stamp = static_cast<int64_t>(time_us);
  return newest_ ? *newest_ + WrapHour(stamp - *newest_) : stamp;
}

void SensorClock::Anchor(int64_t offset, TimeSource source) {
  offset_ = offset;
  anchored_by_ = source;
  claimed_offset_.reset();
}

void SensorClock::Hear(const PositionPacket& position) {
  if (!position.pps_locked || !position.gps_utime) return;
  if (!newest_) {
    early_ = position;
    return;
  }
  const int64_t stamp = Unwrapped(position.time_us);
  // The sentence names the second of the last pulse; the stamp says where in the hour that is.
  const int64_t utime =
      *position.gps_utime + WrapHour(static_cast<int64_t>(position.time_us) - *position.gps_utime);
  const int64_t offset = utime - stamp;
  if (offset_ == offset || !offset_ || anchored_by_ == TimeSource::kHost ||
      claimed_offset_ == offset) {
    Anchor(offset, TimeSource::kGnss);
    last_gps_ = stamp;
  } else {
    claimed_offset_ = offset;
  }
}

void SensorClock::Restart(uint32_t time_us) {
  newest_ = time_us;
  started_ = *newest_;
  offset_.reset();
  anchored_by_ = TimeSource::kUnknown;
  last_gps_.reset();
  claimed_offset_.reset();
  other_newest_us_.reset();
}

bool SensorClock::Advance(uint32_t time_us, int64_t receive_utime) {
  if (!newest_) {
    Restart(time_us);
    if (early_) Hear(*early_);
    return true;
  }
  const int64_t stamp = Unwrapped(time_us);
  if (stamp <= *newest_) {
    const bool goes_on = other_newest_us_ && time_us > *other_newest_us_;
    if (!goes_on) other_first_us_ = time_us;
    other_newest_us_ = time_us;
    if (SecondsBetween(other_first_us_, time_us) < params_.restart_s) return false;
    Restart(time_us);
    return true;
  }
  other_newest_us_.reset();
  newest_ = stamp;
  if (!offset_ && SecondsBetween(started_, stamp) >= params_.gnss_wait_s)
    Anchor(receive_utime - stamp, TimeSource::kHost);
  return true;
}

std::optional<int64_t> SensorClock::utime() const {
  if (!offset_ || !newest_) return std::nullopt;
  return *newest_ + *offset_;
}

TimeSource SensorClock::source() const {
  if (anchored_by_ != TimeSource::kGnss || !newest_) return anchored_by_;
  return SecondsBetween(last_gps_.value_or(*newest_), *newest_) > params_.gnss_hold_s
             ? TimeSource::kHeld
             : TimeSource::kGnss;
}

}  // namespace hairpin
