#pragma once

#include <string>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "daemons/velocity_estimator/velocity_estimator.hpp"

namespace hairpin {

/// What a reading can be at all; beyond, the message is refused.
struct VelocityLimits {
  double max_speed = 0.0;         // m/s
  double max_yaw_rate = 0.0;      // rad/s
  double max_acceleration = 0.0;  // m/s^2
  double min_quality = 0.0;       // of the optical sensor, 0 to 1
};

struct VelocityEstimatorNodeParams {
  VelocityEstimatorParams estimator;
  VelocityLimits limits;
};

/// Reads `velocity_estimator.yaml` and `car.yaml`; deadlines come from the channel table. Throws
/// ConfigError.
VelocityEstimatorNodeParams LoadVelocityEstimatorParams(const Config& config);

/// IMU, GROUND_SPEED, MOTORS, STEERING, GNSS in; VELOCITY out for each IMU message. While the IMU
/// is silent, MOTORS or GROUND_SPEED lead instead.
class VelocityEstimatorNode {
 public:
  VelocityEstimatorNode(const VelocityEstimatorNodeParams& params, Bus& bus);
  VelocityEstimatorNode(const VelocityEstimatorNode&) = delete;
  VelocityEstimatorNode& operator=(const VelocityEstimatorNode&) = delete;

 private:
  template <class M, class Reading>
  bool Take(const Channel<M>& channel, const std::string& problem, const Reading& reading);
  void Publish(int64_t utime);
  void PublishInPlaceOfImu(int64_t utime);
  std::string ProblemOf(const imu_t& message) const;
  std::string ProblemOf(const ground_speed_t& message) const;
  std::string ProblemOf(const motors_t& message) const;
  std::string ProblemOf(const steering_t& message) const;
  std::string ProblemOf(const gnss_t& message) const;

  Bus& bus_;
  Car car_;
  VelocityLimits limits_;
  VelocityEstimator estimator_;
};

}  // namespace hairpin
