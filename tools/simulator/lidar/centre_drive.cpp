#include "tools/simulator/lidar/centre_drive.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr double kReach = 1.5;  // m: the line is averaged over twice this: corners are round
constexpr int kSamples = 30;    // of the average
constexpr double kStep = 0.01;  // m: of the turn's derivative

}  // namespace

CentreDrive::CentreDrive(const Track& track, double speed)
    : line_(CentreLine(track)),
      closed_(track.closed),
      length_(Length(line_, false)),  // a closed one ends where it begins
      speed_(speed) {
  RequirePositive("speed", speed);
}

Eigen::Vector2d CentreDrive::OnLine(double station) const {
  double rest = closed_ ? station - length_ * std::floor(station / length_)
                        : std::clamp(station, 0.0, length_);
  for (size_t i = 0; i + 1 < line_.size(); ++i) {
    const Eigen::Vector2d step = line_[i + 1] - line_[i];
    if (rest <= step.norm()) return line_[i] + step.normalized() * rest;
    rest -= step.norm();
  }
  return line_.back();
}

Eigen::Vector2d CentreDrive::PositionAt(double station) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < kSamples; ++i)
    sum += OnLine(station + kReach * ((2.0 * i + 1.0) / kSamples - 1.0));
  return sum / kSamples;
}

// The derivative of an average over [s - kReach, s + kReach] is the chord between its ends, over
// its length.
Eigen::Vector2d CentreDrive::TangentAt(double station) const {
  return (OnLine(station + kReach) - OnLine(station - kReach)) / (2.0 * kReach);
}

VehicleState CentreDrive::At(double time) const {
  const double station = speed_ * time;
  const Eigen::Vector2d position = PositionAt(station);
  const Eigen::Vector2d tangent = TangentAt(station);
  const auto yaw = [this](double at) {
    const Eigen::Vector2d direction = TangentAt(at);
    return std::atan2(direction.y(), direction.x());
  };
  const double yaw_rate =
      WrapAngle(yaw(station + kStep) - yaw(station - kStep)) / (2.0 * kStep) * speed_;
  VehicleState state;
  state.T_map_base = {position.x(), position.y(), yaw(station)};
  state.velocity = {speed_ * tangent.norm(), 0.0, yaw_rate};
  state.acceleration = {0.0, state.velocity.vx * yaw_rate};
  state.distance = station;
  return state;
}

}  // namespace hairpin
