#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "daemons/can_gateway/drive_order.hpp"

namespace hairpin {

struct CommandLimits {
  double max_steering_angle = 0.0;  // [rad], > 0
  double max_wheel_torque = 0.0;    // [N m], > 0
  double steering_rate = 0.0;       // [rad/s], > 0
  double torque_rate = 0.0;  // [N m/s], > 0; away from zero only: to let go is always permitted
  double brake_rate = 0.0;   // [1/s], > 0; when releasing only: to brake is always permitted
};

/// Keeps orders within the car's limits in value and rate.
class CommandLimiter {
 public:
  /// Throws std::invalid_argument for limits out of bounds.
  explicit CommandLimiter(const CommandLimits& limits);

  /// `order` as far as it may be followed, `duration` [s] after the last. A controlled stop takes
  /// no driving torque.
  DriveOrder Limit(const DriveOrder& order, double duration, bool controlled_stop);
  /// The next order is limited from here on: what the actuators were told meanwhile.
  void Reset(const DriveOrder& order) { last_ = order; }

  /// How often each limit, by its name, was met.
  const std::map<std::string, int64_t>& counts() const { return counts_; }

 private:
  double Note(const char* limit, double wanted, double allowed);
  double Torque(double wanted, double last, double duration, bool controlled_stop);

  CommandLimits limits_;
  DriveOrder last_;
  std::map<std::string, int64_t> counts_;
};

}  // namespace hairpin
