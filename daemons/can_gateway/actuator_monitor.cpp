#include "daemons/can_gateway/actuator_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxOrders = 1'000;

}  // namespace

void ActuatorMonitor::Excess::Update(int64_t utime, double excess, double tolerance,
                                     double factor) {
  if (excess <= tolerance) disagrees_since = 0;
  if (excess > tolerance && disagrees_since == 0) disagrees_since = utime;
  if (excess <= factor * tolerance) diverges_since = 0;
  if (excess > factor * tolerance && diverges_since == 0) diverges_since = utime;
}

ActuatorVerdict ActuatorMonitor::Excess::Verdict(int64_t now, double lasting) const {
  const auto lasts = [&](int64_t since) {
    return since != 0 && SecondsBetween(since, now) >= lasting;
  };
  if (lasts(diverges_since)) return ActuatorVerdict::kDiverge;
  return lasts(disagrees_since) ? ActuatorVerdict::kDisagree : ActuatorVerdict::kAgree;
}

ActuatorMonitor::ActuatorMonitor(const ActuatorMonitorParams& params) : params_(params) {
  const double positive[] = {params.disagreement_time,  params.steering_rate,
                             params.steering_tolerance, params.torque_tolerance,
                             params.brake_tolerance,    params.settling_time,
                             params.feedback_timeout};
  const bool good = std::all_of(std::begin(positive), std::end(positive),
                                [](double value) { return value > 0.0; });
  if (!good || !(params.diverging_factor > 1.0) || !(params.steering_delay >= 0.0))
    throw std::invalid_argument("actuator monitor: a parameter is out of bounds");
}

void ActuatorMonitor::Reset(int64_t utime) {
  orders_.clear();
  steering_ = torque_ = brake_ = {};
  steering_utime_ = 0;
  reset_utime_ = utime;
  culprit_.clear();
}

void ActuatorMonitor::Ordered(int64_t utime, const DriveOrder& order) {
  orders_.push_back({utime, order});
  const double kept = std::max(params_.settling_time, params_.steering_delay);
  while (orders_.size() > kMaxOrders ||
         (orders_.size() > 1 && SecondsBetween(orders_[1].utime, utime) > kept))
    orders_.pop_front();
}

double ActuatorMonitor::SteeringOrderAt(int64_t utime) const {
  double angle = orders_.front().order.steering_angle;
  for (const Order& order : orders_) {
    if (order.utime <= utime) angle = order.order.steering_angle;
  }
  return angle;
}

void ActuatorMonitor::Measured(const SteeringSample& sample) {
  if (orders_.empty()) return;
  if (steering_utime_ == 0) steering_model_ = sample.angle;  // wherever the wheels stood
  const double duration =
      steering_utime_ == 0 ? 0.0 : std::max(0.0, SecondsBetween(steering_utime_, sample.utime));
  steering_utime_ = sample.utime;
  const double wanted = SteeringOrderAt(AddSeconds(sample.utime, -params_.steering_delay));
  const double step = params_.steering_rate * duration;
  steering_model_ += std::clamp(wanted - steering_model_, -step, step);
  steering_.Update(sample.utime, std::abs(sample.angle - steering_model_),
                   params_.steering_tolerance, params_.diverging_factor);
}

void ActuatorMonitor::Measured(const MotorsSample& sample) {
  if (orders_.empty()) return;
  double excess = 0.0;
  for (size_t i = 0; i < 4; ++i) {
    double low = 0.0;
    double high = 0.0;
    for (const Order& order : orders_) {
      low = std::min(low, order.order.wheel_torque[i]);
      high = std::max(high, order.order.wheel_torque[i]);
    }
    excess = std::max({excess, sample.torque[i] - high, low - sample.torque[i]});
  }
  torque_.Update(sample.utime, excess, params_.torque_tolerance, params_.diverging_factor);
}

void ActuatorMonitor::Measured(const BrakeSample& sample) {
  if (orders_.empty()) return;
  // Nothing was asked for before the first order.
  const bool settled = SecondsBetween(reset_utime_, sample.utime) > params_.settling_time;
  double wanted = settled ? 1.0 : 0.0;
  for (const Order& order : orders_) wanted = std::min(wanted, order.order.brake);
  brake_.Update(sample.utime, wanted - sample.level, params_.brake_tolerance,
                params_.diverging_factor);
}

ActuatorVerdict ActuatorMonitor::Judge(int64_t now) {
  ActuatorVerdict worst = ActuatorVerdict::kAgree;
  const auto consider = [&](ActuatorVerdict verdict, const char* name) {
    if (verdict <= worst) return;
    worst = verdict;
    culprit_ = name;
  };
  const int64_t heard = std::max(steering_utime_, reset_utime_);
  if (SecondsBetween(heard, now) > params_.feedback_timeout)
    consider(ActuatorVerdict::kDisagree, "no steering angle");
  consider(steering_.Verdict(now, params_.disagreement_time), "steering");
  consider(torque_.Verdict(now, params_.disagreement_time), "motors");
  consider(brake_.Verdict(now, params_.disagreement_time), "brake");
  return worst;
}

}  // namespace hairpin
