#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemons/velocity_estimator/measurements.hpp"
#include "daemons/velocity_estimator/velocity_estimator_params.hpp"

namespace hairpin {

/// x = [v_x v_y | r | a_x a_y | s_fl s_fr s_rl s_rr], of base: m/s, rad/s, m/s^2, wheel slips.
enum StateIndex : int { kVelocity = 0, kYawRate = 2, kAcceleration = 3, kSlip = 5, kStateSize = 9 };
using StateVector = Eigen::Matrix<double, kStateSize, 1>;
using StateMatrix = Eigen::Matrix<double, kStateSize, kStateSize>;

/// Moves the state by `dt` [s], of either sign: v' = a + r [v_y, -v_x]; r, a and slips stay.
StateVector Move(const StateVector& state, double dt);

/// Velocity in base of a point fixed to the car: v + r x p.
Eigen::Vector2d VelocityAt(const StateVector& state, const Eigen::Vector2d& position);

/// Slip angle of a tyre that passes `acceleration` times its load over g: the inverse of the tyre
/// curve, level near the limit [rad].
double SlipAngle(double acceleration, const LateralTyreParams& tyre, double friction);

/// Slip of the wheels as a first-order Gauss-Markov process about what the tyres' stiffness says
/// for the present longitudinal force, in parts as the load. Its deviation is bounded by the force
/// that each tyre passes: motor torque, and the friction brakes' share of the deceleration. A free
/// wheel hardly slips. Where the torque is not measured, the acceleration tells it, in equal parts.
class SlipModel {
 public:
  SlipModel(const SlipParams& params, const LateralTyreParams& tyre, const Car& car)
      : params_(params), tyre_(tyre), car_(car) {}

  /// The slip about which all wheels vary, for a longitudinal acceleration [m/s^2].
  double Mean(double acceleration) const;

  /// Standard deviations of the slips, for motor torques [N m] and longitudinal acceleration
  /// [m/s^2].
  Wheels Sigmas(const std::optional<Wheels>& torque, double acceleration) const;
  /// Share of a slip that is left after `dt`.
  double Decay(double dt) const;

 private:
  SlipParams params_;
  LateralTyreParams tyre_;
  Car car_;
};

/// Covariance that `dt` of motion adds.
StateMatrix ProcessNoise(const MotionNoise& noise, const Wheels& slip_sigmas, double slip_decay,
                         double dt);

/// The hub of one wheel and the direction in which it rolls.
struct WheelGeometry {
  Eigen::Vector2d position;   // base
  Eigen::Vector2d direction;  // base, unit
};

/// fl fr rl rr, the front ones turned by `steering_angle`.
std::array<WheelGeometry, 4> WheelGeometries(const Car& car, double steering_angle);

/// The same where nobody knows how far the front wheels are turned: a wheel rolls where its hub
/// goes, but for the slip angle, whose cosine is within 1 % of 1.
std::array<WheelGeometry, 4> WheelGeometriesAlong(const Car& car, const StateVector& state);

/// Lateral velocity of the rear axle beyond what its tyres' slip angle explains, v_y - r l_r + v_x
/// alpha(a_y): near zero while the rear tyres grip [m/s].
double RearAxleSlide(const StateVector& state, const VelocityEstimatorParams& params);

/// Longitudinal velocity of the hub, v_x,ij: d . (v + r x p) [m/s].
double HubSpeed(const StateVector& state, const WheelGeometry& wheel);

/// Wheel speed w = v_x,ij / R (1 + s) [rad/s]; below `min_speed`, where slip means nothing, w =
/// (v_x,ij + s min_speed) / R.
double WheelSpeed(double hub_speed, double slip, double radius, double min_speed);

/// The antenna's velocity, turned into base by the heading.
Eigen::Vector2d VelocityInBase(const GnssReading& reading);
/// Its covariance: the receiver's, not below `noise`, and the heading's across the velocity.
Eigen::Matrix2d CovarianceInBase(const GnssReading& reading, const SensorNoise& noise);

}  // namespace hairpin
