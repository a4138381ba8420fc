#include "daemons/can_gateway/command_limiter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hairpin {

CommandLimiter::CommandLimiter(const CommandLimits& limits) : limits_(limits) {
  const double all[] = {limits.max_steering_angle, limits.max_wheel_torque, limits.steering_rate,
                        limits.torque_rate, limits.brake_rate};
  if (!std::all_of(std::begin(all), std::end(all), [](double limit) { return limit > 0.0; }))
    throw std::invalid_argument("command limits must be > 0");
}

double CommandLimiter::Note(const char* limit, double wanted, double allowed) {
  // A rounding error is no breach.
  if (std::abs(wanted - allowed) > 1e-9) ++counts_[limit];
  return allowed;
}

double CommandLimiter::Torque(double wanted, double last, double duration, bool controlled_stop) {
  double torque = Note("torque value", wanted,
                       std::clamp(wanted, -limits_.max_wheel_torque, limits_.max_wheel_torque));
  if (controlled_stop) torque = Note("torque in a controlled stop", torque, std::min(torque, 0.0));
  const double step = limits_.torque_rate * duration;
  return Note("torque rate", torque,
              std::clamp(torque, std::min(last, 0.0) - step, std::max(last, 0.0) + step));
}

DriveOrder CommandLimiter::Limit(const DriveOrder& order, double duration, bool controlled_stop) {
  DriveOrder result;
  const double max_angle = limits_.max_steering_angle;
  const double angle = Note("steering value", order.steering_angle,
                            std::clamp(order.steering_angle, -max_angle, max_angle));
  const double step = limits_.steering_rate * duration;
  result.steering_angle =
      Note("steering rate", angle,
           std::clamp(angle, last_.steering_angle - step, last_.steering_angle + step));
  for (size_t i = 0; i < 4; ++i) {
    result.wheel_torque[i] =
        Torque(order.wheel_torque[i], last_.wheel_torque[i], duration, controlled_stop);
  }
  const double brake = Note("brake value", order.brake, std::clamp(order.brake, 0.0, 1.0));
  result.brake =
      Note("brake rate", brake, std::max(brake, last_.brake - limits_.brake_rate * duration));
  last_ = result;
  return result;
}

}  // namespace hairpin
