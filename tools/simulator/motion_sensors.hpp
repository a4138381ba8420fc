#pragma once

#include <cstdint>

#include "common/car.hpp"
#include "hairpin/gnss_t.hpp"
#include "hairpin/ground_speed_t.hpp"
#include "hairpin/imu_t.hpp"
#include "hairpin/motors_t.hpp"
#include "hairpin/steering_t.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

/// Noise and error of the motion sensors. "noise" is white, one sigma of a sample; "bias" the sigma
/// of a bias that wanders with its correlation time; "scale" the sigma of a scale error drawn once
/// a run.
struct MotionSensorParams {
  double gyro_noise_radps = 0.0;
  double gyro_bias_radps = 0.0;
  double gyro_scale = 0.0;
  double accelerometer_noise_mps2 = 0.0;
  double accelerometer_bias_mps2 = 0.0;
  double accelerometer_scale = 0.0;
  double imu_bias_time_s = 0.0;
  double wheel_speed_noise_radps = 0.0;
  double wheel_torque_noise_nm = 0.0;
  double wheel_torque_scale = 0.0;
  double steering_noise_rad = 0.0;
  double steering_offset_rad = 0.0;  // sigma, drawn once a run
  double ground_speed_noise_mps = 0.0;
  double ground_speed_scale = 0.0;
  double ground_speed_misalignment_rad = 0.0;   // sigma of the mount's yaw error, drawn once a run
  int32_t gnss_fix = gnss_t::FIX_DIFFERENTIAL;  // as the receiver calls its solution
  double gnss_position_bias_m = 0.0;            // per axis, wandering
  double gnss_position_bias_time_s = 0.0;
  double gnss_position_noise_m = 0.0;
  double gnss_velocity_noise_mps = 0.0;
  double gnss_heading_noise_rad = 0.0;
};

/// IMU at the centre of gravity, wheel resolvers and motor currents, steering sensor, optical
/// ground speed sensor and dual-antenna GNSS at their mounts. Each with a random stream of its own,
/// so that none depends on another's use. The map frame is taken for east, north, up from the
/// geodetic origin.
class MotionSensors {
 public:
  /// Throws std::invalid_argument for values that cannot be.
  MotionSensors(const MotionSensorParams& params, const Car& car, uint64_t seed);

  /// Measurements of `state` at `utime`. `duration` [s]: since the last one, for the biases.
  imu_t Imu(int64_t utime, const VehicleState& state, double duration);
  motors_t Motors(int64_t utime, const VehicleState& state);
  steering_t Steering(int64_t utime, const VehicleState& state);
  ground_speed_t GroundSpeed(int64_t utime, const VehicleState& state);
  gnss_t Gnss(int64_t utime, const VehicleState& state, double duration);

 private:
  struct InertialAxis {
    InertialAxis(double scale_sigma, double bias_sigma, double bias_time, RandomStream& random);
    double Measure(double truth, double noise, double duration, RandomStream& random);
    double scale;
    WanderingBias bias;
  };

  MotionSensorParams params_;
  Car car_;
  RandomStream imu_random_;
  RandomStream motors_random_;
  RandomStream steering_random_;
  RandomStream ground_speed_random_;
  RandomStream gnss_random_;
  std::vector<InertialAxis> accelerometers_;  // x y z
  std::vector<InertialAxis> gyros_;           // x y z
  double torque_scale_;
  double steering_offset_;
  double ground_speed_scale_;
  double ground_speed_yaw_;
  std::vector<WanderingBias> gnss_bias_;  // east north up
};

}  // namespace hairpin
