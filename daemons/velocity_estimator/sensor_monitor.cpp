#include "daemons/velocity_estimator/sensor_monitor.hpp"

#include <algorithm>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr int kFrozenReadings = 3;  // a slow sensor may well say the same twice

}  // namespace

bool SensorMonitor::Judge(int64_t utime, bool agrees) {
  const bool was_silent = !last_utime_ || SecondsBetween(*last_utime_, utime) > deadline_;
  if (was_silent || agrees != last_agreed_) streak_start_ = utime;
  last_agreed_ = agrees;
  last_utime_ = utime;
  const double streak = SecondsBetween(streak_start_, utime);
  if (!agrees && streak >= params_.reject_after) is_out_ = true;
  if (agrees && streak >= params_.readmit_after) is_out_ = false;
  return agrees && !is_out_;
}

void SensorMonitor::TakeOut(int64_t utime) {
  is_out_ = true;
  last_agreed_ = false;
  streak_start_ = utime;
}

void SensorMonitor::Forgive() {
  is_out_ = false;
  last_agreed_ = true;
  last_utime_.reset();
  streak_start_ = 0;
}

bool SensorMonitor::IsFrozen(int64_t utime, const Eigen::Vector2d& reading, bool moving) {
  if (!moving || !reading_since_ || reading != reading_) {
    reading_ = reading;
    reading_since_ = utime;
    equal_readings_ = 0;
  }
  equal_readings_ = std::min(equal_readings_ + 1, kFrozenReadings);
  return equal_readings_ == kFrozenReadings &&
         SecondsBetween(*reading_since_, utime) >= params_.frozen_after;
}

SensorState SensorMonitor::StateAt(int64_t now) const {
  if (!last_utime_ || SecondsBetween(*last_utime_, now) > deadline_) return SensorState::kSilent;
  return is_out_ ? SensorState::kRejected : SensorState::kUsed;
}

}  // namespace hairpin
