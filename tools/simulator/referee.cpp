#include "tools/simulator/referee.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "common/clock.hpp"
#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

// Half the side of a cone's base [rules: 228 mm small, 285 mm large].
double BaseRadius(ConeColour colour) { return colour == ConeColour::kOrangeLarge ? 0.1425 : 0.114; }

std::string Seconds(double value) {
  std::ostringstream text;
  text << value << " s";
  return text.str();
}

}  // namespace

Referee::Referee(const RefereeParams& params, const Car& car, const Track& track)
    : params_(params), car_(car), area_(track), lines_(track) {
  RequireWithin("laps", params.laps, 1, 1000);
  RequirePositive("start_limit", params.start_limit_s);
  RequirePositive("time_limit_per_lap", params.time_limit_per_lap_s);
  RequirePositive("stop_distance", params.stop_distance_m);
  RequirePositive("finish_limit", params.finish_limit_s);
  RequirePositive("no_movement_limit", params.no_movement_limit_s);
  RequirePositive("standstill", params.standstill_mps);
  RequireNotNegative("braking_distance", params.braking_distance_m);
  for (const auto* cones : {&track.left, &track.right, &track.others}) {
    standing_cones_.insert(standing_cones_.end(), cones->begin(), cones->end());
  }
}

void Referee::Judge(const RefereeInput& input, const VehicleState& state) {
  if (done_) return;
  if (!first_utime_) first_utime_ = input.utime;
  const double time = SecondsBetween(*first_utime_, input.utime);
  CountLaps(input, state);
  KnockDownCones(state.T_map_base);
  CheckCourse(state.T_map_base);
  Measure(state, time);
  CheckEnd(input, state, time);
  last_position_ = state.T_map_base.position();
  last_time_ = time;
  last_distance_ = state.distance;
}

void Referee::CountLaps(const RefereeInput& input, const VehicleState& state) {
  if (!last_position_ || finish_) return;
  const double time = SecondsBetween(*first_utime_, input.utime);
  const auto at = [](double from, double to, double share) { return from + share * (to - from); };
  const std::optional<double> share = lines_.Cross(*last_position_, state.T_map_base.position());
  if (share) OnLine(at(last_time_, time, *share), at(last_distance_, state.distance, *share));
}

void Referee::OnLine(double time, double distance) {
  if (!lap_start_) {
    timed_start_ = time;
    timed_start_distance_ = distance;
  } else {
    result_.lap_times_s.push_back(time - *lap_start_);
    if (laps() == params_.laps) {
      finish_ = time;
      finish_distance_ = distance;
    }
  }
  lap_start_ = time;
}

bool Referee::IsHit(const TrackCone& cone, const Pose2& T_base_map) const {
  // Distance from the body's rectangle to the cone's centre, against the cone's base.
  const Eigen::Vector2d p = T_base_map * cone.position;
  const double dx = std::max({p.x() - car_.front_overhang, -car_.rear_overhang - p.x(), 0.0});
  const double dy = std::max(std::abs(p.y()) - 0.5 * car_.body_width, 0.0);
  return std::hypot(dx, dy) < BaseRadius(cone.colour);
}

void Referee::KnockDownCones(const Pose2& T_map_base) {
  const Pose2 T_base_map = T_map_base.Inverse();
  const auto hit = std::erase_if(standing_cones_,
                                 [&](const TrackCone& cone) { return IsHit(cone, T_base_map); });
  result_.cones_hit += static_cast<int>(hit);
}

void Referee::CheckCourse(const Pose2& T_map_base) {
  const auto wheels = car_.wheel_positions();
  const bool outside = std::none_of(
      wheels.begin(), wheels.end(),
      [&](const Eigen::Vector2d& wheel) { return area_.Contains(T_map_base * wheel); });
  if (outside && !outside_) ++result_.off_course;
  outside_ = outside;
}

void Referee::Measure(const VehicleState& state, double time) {
  result_.distance_m = state.distance;
  result_.max_speed_mps =
      std::max(result_.max_speed_mps, std::hypot(state.velocity.vx, state.velocity.vy));
  if (!timed_start_) return;
  const double end = finish_.value_or(time);
  const double end_distance = finish_ ? finish_distance_ : state.distance;
  if (end > *timed_start_)
    result_.mean_speed_mps = (end_distance - timed_start_distance_) / (end - *timed_start_);
}

void Referee::CheckEnd(const RefereeInput& input, const VehicleState& state, double time) {
  if (input.driving && !driving_since_) driving_since_ = time;
  if (!driving_since_) {
    if (!input.emergency.empty()) return End(false, "did not start: " + input.emergency);
    if (time > params_.start_limit_s)
      End(false, "did not start within " + Seconds(params_.start_limit_s));
    return;
  }
  if (finish_) {
    CheckStop(input, state, time);
  } else {
    CheckDrive(input, state, time);
  }
}

void Referee::CheckDrive(const RefereeInput& input, const VehicleState& state, double time) {
  const bool moves = std::abs(state.velocity.vx) > params_.standstill_mps;
  if (moves || !last_movement_) last_movement_ = time;
  if (!input.emergency.empty()) return CheckEmergency(input, state, moves);
  if (input.finished) return End(false, "AS Finished before the finish");
  if (time - *last_movement_ > params_.no_movement_limit_s) {
    return End(false, "no movement for " + Seconds(params_.no_movement_limit_s));
  }
  const double limit = params_.laps * params_.time_limit_per_lap_s;
  if (time - *driving_since_ > limit) End(false, "time limit of " + Seconds(limit) + " exceeded");
}

void Referee::CheckEmergency(const RefereeInput& input, const VehicleState& state, bool moves) {
  if (!emergency_distance_) emergency_distance_ = state.distance;
  if (moves) return;
  const bool brake_test = params_.braking_distance_m > 0.0 && input.res_stop;
  if (!brake_test) return End(false, "emergency brake: " + input.emergency);
  const double distance = state.distance - *emergency_distance_;
  std::ostringstream reason;
  reason << "brake test: stands " << std::fixed << std::setprecision(1) << distance
         << " m after the RES";
  End(distance <= params_.braking_distance_m, reason.str());
}

void Referee::CheckStop(const RefereeInput& input, const VehicleState& state, double time) {
  const double distance = state.distance - finish_distance_;
  if (!input.emergency.empty()) return End(false, "emergency after the finish: " + input.emergency);
  if (distance > params_.stop_distance_m) {
    std::ostringstream reason;
    reason << "did not stop within " << params_.stop_distance_m << " m after the finish";
    return End(false, reason.str());
  }
  const bool stands = std::abs(state.velocity.vx) <= params_.standstill_mps;
  if (stands && input.finished) return End(true, "finished");
  if (time - *finish_ > params_.finish_limit_s) {
    End(false, std::string(stands ? "no AS Finished" : "no standstill") + " within " +
                   Seconds(params_.finish_limit_s) + " after the finish");
  }
}

void Referee::End(bool finished, const std::string& reason) {
  done_ = true;
  result_.finished = finished;
  result_.reason = reason;
}

}  // namespace hairpin
