#pragma once

#include "common/car.hpp"
#include "daemons/velocity_estimator/sensor_monitor.hpp"
#include "daemons/velocity_estimator/standstill.hpp"

namespace hairpin {

/// Process noise: standard deviation gathered in one second, of what the model leaves out.
struct MotionNoise {
  double velocity = 0.0;      // m/s: acceleration that no accelerometer sees (tilt, mounting)
  double yaw_rate = 0.0;      // rad/s: yaw acceleration
  double acceleration = 0.0;  // m/s^2: jerk
};

/// Wheel slip as a stationary process: mean 0, standard deviation by the force that the tyre
/// passes.
struct SlipParams {
  double sigma_free = 0.0;      // rolling freely; also what the wheel's radius is off by
  double sigma_at_limit = 0.0;  // added where the force reaches friction * load
  double time_constant = 0.0;   // s
  double friction = 0.0;        // of tyre on road
  double min_speed = 0.0;       // m/s below which slip is measured against this speed
};

/// The tyres, all alike: lateral force over load by slip angle, D sin(C atan(B alpha)) [Pacejka
/// 1987, without E], D = SlipParams::friction. Their longitudinal slip has the same stiffness.
struct LateralTyreParams {
  double stiffness = 0.0;            // B C D, per rad and per unit of slip
  double shape = 0.0;                // C
  double sigma_angle = 0.0;          // rad that the slip angle is off by: rolling straight
  double sigma_angle_share = 0.0;    // and in proportion to it
  double angle_time_constant = 0.0;  // s that such an error lasts
};

struct SensorNoise {
  double gyro = 0.0;                     // rad/s
  double accelerometer = 0.0;            // m/s^2
  double ground_speed = 0.0;             // m/s
  double ground_speed_scale = 0.0;       // of the speed
  double wheel_speed = 0.0;              // rad/s
  double steering = 0.0;                 // rad
  double steering_yaw_rate = 0.0;        // rad/s, of the yaw rate by steering angle: at rest
  double steering_yaw_rate_scale = 0.0;  // and in proportion to it
  double gnss_velocity = 0.0;            // m/s; the receiver's own figure where that is larger
  double gnss_heading = 0.0;             // rad; the same
};

/// Seconds after which a sensor counts as silent.
struct SensorDeadlines {
  double imu = 0.0;
  double ground_speed = 0.0;
  double motors = 0.0;
  double steering = 0.0;
  double gnss = 0.0;
};

/// Systematic errors that a sound sensor may have, in the votes.
struct VoteParams {
  double time_constant = 0.0;         // s over which the sensors are averaged
  double speed_offset = 0.0;          // m/s
  double speed_scale = 0.0;           // of the speed; optical sensor and GNSS
  double gyro_offset = 0.0;           // rad/s
  double heading_rate = 0.0;          // rad/s, from the change of the GNSS heading
  double lateral_acceleration = 0.0;  // m/s^2 that v_y' and tilt leave in the average
  double min_speed = 0.0;             // m/s above which acceleration tells the yaw rate
};

struct VelocityEstimatorParams {
  Car car;
  MotionNoise motion;
  SlipParams slip;
  LateralTyreParams tyre;
  SensorNoise noise;
  SensorDeadlines deadlines;
  SensorMonitorParams monitor;
  StandstillParams standstill;
  VoteParams vote;
  double gate_1dof = 0.0;  // chi-square bounds by degrees of freedom
  double gate_2dof = 0.0;
  double max_age = 0.0;             // s that a reading may lie before or behind the filter's time
  double max_gap = 0.0;             // s that the filter predicts over; beyond, it starts anew
  double max_velocity_sigma = 0.0;  // m/s, of a valid estimate
  double max_yaw_rate_sigma = 0.0;  // rad/s, of a valid estimate
};

/// Throws std::invalid_argument with parameter, relation and bound.
void Validate(const VelocityEstimatorParams& params);

}  // namespace hairpin
