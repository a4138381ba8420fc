#pragma once

#include <array>
#include <cstdint>

namespace hairpin {

/// What the actuators are to do.
struct DriveOrder {
  double steering_angle = 0.0;           // of the front wheels, positive to the left [rad]
  std::array<double, 4> wheel_torque{};  // fl fr rl rr [N m]
  double brake = 0.0;                    // 0 to 1 of full pressure
};

/// A command as it comes from the planner.
struct Command {
  int64_t utime = 0;
  bool asks_to_move = false;  // anything but to stand with brakes
  DriveOrder order;
  double target_speed = 0.0;  // m/s, for the data logger
};

/// Newest word of the mission manager.
struct AsReport {
  int64_t utime = 0;
  int state = 0;    // numbered as in as_state_t
  int mission = 0;  // as in vehicle_t
  int lap = 0;
  bool mission_finished = false;
};

/// Newest word of the watchdog.
struct SupervisorReport {
  int64_t utime = 0;
  bool stop = false;       // controlled stop asked for
  bool emergency = false;  // emergency brake asked for
};

}  // namespace hairpin
