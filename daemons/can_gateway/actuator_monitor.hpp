#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "daemons/can_gateway/drive_order.hpp"
#include "daemons/can_gateway/measurements.hpp"

namespace hairpin {

struct ActuatorMonitorParams {
  double disagreement_time = 0.0;   // [s], > 0, after which a disagreement counts
  double diverging_factor = 0.0;    // > 1: of the tolerance, from which on it diverges
  double steering_delay = 0.0;      // [s], >= 0
  double steering_rate = 0.0;       // [rad/s], > 0, of the actuator
  double steering_tolerance = 0.0;  // [rad], > 0
  double torque_tolerance = 0.0;    // [N m], > 0, by which a motor may exceed what was asked for
  double brake_tolerance = 0.0;     // > 0, by which the pressure may lag
  double settling_time = 0.0;       // [s], > 0: what was asked for within it may be what acts
  double feedback_timeout = 0.0;    // [s], > 0: no feedback is no agreement
};

enum class ActuatorVerdict { kAgree, kDisagree, kDiverge };

/// Whether the actuators do what they are told [FAULTS 32]. Steering is compared with a model of
/// its delay and rate; a motor must not give more than what was asked for of late, the brake no
/// less. A breach counts once it has lasted.
class ActuatorMonitor {
 public:
  /// Throws std::invalid_argument for parameters out of bounds.
  explicit ActuatorMonitor(const ActuatorMonitorParams& params);

  /// Forgets everything: the car begins to drive at `utime`.
  void Reset(int64_t utime);
  /// What was sent to the actuators.
  void Ordered(int64_t utime, const DriveOrder& order);
  void Measured(const SteeringSample& sample);
  void Measured(const MotorsSample& sample);
  void Measured(const BrakeSample& sample);

  /// The worst of all at `now`, and the actuator's name.
  ActuatorVerdict Judge(int64_t now);
  const std::string& culprit() const { return culprit_; }

 private:
  /// Since when an excess over the tolerance, and over the larger one, has lasted.
  struct Excess {
    void Update(int64_t utime, double excess, double tolerance, double factor);
    ActuatorVerdict Verdict(int64_t now, double lasting) const;
    int64_t disagrees_since = 0;
    int64_t diverges_since = 0;
  };
  struct Order {
    int64_t utime;
    DriveOrder order;
  };

  double SteeringOrderAt(int64_t utime) const;

  ActuatorMonitorParams params_;
  std::deque<Order> orders_;  // of the settling time, and one before it
  double steering_model_ = 0.0;
  int64_t steering_utime_ = 0;  // of the model; 0: none yet
  int64_t reset_utime_ = 0;
  Excess steering_;
  Excess torque_;
  Excess brake_;
  std::string culprit_;
};

}  // namespace hairpin
