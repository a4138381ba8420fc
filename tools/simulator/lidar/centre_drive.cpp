#include "tools/simulator/lidar/centre_drive.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr double kReach =
    1.5;  // m: directions are taken over twice this, so that corners are round

}  // namespace

CentreDrive::CentreDrive(const Track& track, double speed)
    : line_(CentreLine(track)),
      closed_(track.closed),
      length_(Length(line_, false)),  // a closed one ends where it begins
      speed_(speed) {
  RequirePositive("speed", speed);
}

Eigen::Vector2d CentreDrive::PositionAt(double station) const {
  double rest = closed_ ? station - length_ * std::floor(station / length_)
                        : std::clamp(station, 0.0, length_);
  for (size_t i = 0; i + 1 < line_.size(); ++i) {
    const Eigen::Vector2d step = line_[i + 1] - line_[i];
    if (rest <= step.norm()) return line_[i] + step.normalized() * rest;
    rest -= step.norm();
  }
  return line_.back();
}

double CentreDrive::YawAt(double station) const {
  const Eigen::Vector2d chord = PositionAt(station + kReach) - PositionAt(station - kReach);
  return std::atan2(chord.y(), chord.x());
}

VehicleState CentreDrive::At(double time) const {
  const double station = speed_ * time;
  const double yaw_rate =
      WrapAngle(YawAt(station + kReach) - YawAt(station - kReach)) / (2.0 * kReach) * speed_;
  const Eigen::Vector2d position = PositionAt(station);
  VehicleState state;
  state.T_map_base = {position.x(), position.y(), YawAt(station)};
  state.velocity = {speed_, 0.0, yaw_rate};
  state.acceleration = {0.0, speed_ * yaw_rate};
  state.distance = station;
  return state;
}

}  // namespace hairpin
