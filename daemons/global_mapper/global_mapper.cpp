#include "daemons/global_mapper/global_mapper.hpp"

#include <cmath>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr double kGateMargin = 2.0;   // m beside the gate's cones that still is through it
constexpr double kLostSpeed = 5.0;    // m/s, of an unknown motion: the sigma that is assumed
constexpr double kLostYawRate = 0.3;  // rad/s
constexpr double kLapOverlap = 30.0;  // m of the lap before that are told with each
constexpr double kMaxJump = 3.0;      // m past the line at one step: the estimate has jumped

/// Of a car of which nothing is known for `seconds` but that it goes no faster than usual.
Motion UnknownMotion(double seconds) {
  Motion motion;
  const double position = std::pow(0.1 + kLostSpeed * seconds, 2);
  motion.covariance =
      Eigen::Vector3d(position, position, std::pow(0.01 + kLostYawRate * seconds, 2)).asDiagonal();
  return motion;
}

/// Without a gate the line goes across where the map began.
MapGate GateOf(const std::vector<GlobalCone>& cones) {
  return FindMapGate(cones).value_or(MapGate{{0.0, kGateMargin}, {0.0, -kGateMargin}});
}

}  // namespace

void GlobalMapperParams::Validate() const {
  map.Validate();
  localiser.Validate();
  odometry.Validate();
  require(min_lap_distance > 0.0, "min_lap_distance must be > 0");
}

GlobalMapper::GlobalMapper(const GlobalMapperParams& params)
    : params_(params), odometry_(params.odometry), map_(params.map) {
  params.Validate();
}

GlobalMapper::GlobalMapper(const GlobalMapperParams& params, const KnownMap& known)
    : GlobalMapper(params) {
  localiser_.emplace(params.localiser, known.cones, known.start);
}

std::string_view GlobalMapper::AddVelocity(int64_t utime, const Twist2& velocity,
                                           const Eigen::Matrix3d& covariance) {
  return odometry_.Add(utime, velocity, covariance);
}

/// Within an epoch the local map's own frame says how the car moved, across a gap of our own making
/// too; VELOCITY says how well, and bridges two epochs.
Motion GlobalMapper::MotionSince(const Seen& before, const LocalMapInput& map) const {
  const auto integrated = odometry_.Between(before.utime, map.utime);
  const double seconds = SecondsBetween(before.utime, map.utime);
  if (before.epoch != map.epoch) return integrated.value_or(UnknownMotion(seconds));
  Motion motion;
  motion.T_from_to = before.T_local_base.Inverse() * map.T_local_base;
  motion.covariance =
      integrated ? integrated->covariance : odometry_.CovarianceOf(motion.T_from_to, seconds);
  return motion;
}

GlobalMapper::Outcome GlobalMapper::AddLocalMap(const LocalMapInput& map) {
  if (last_ && map.utime <= last_->utime) return {std::nullopt, {}, "time does not increase"};
  Outcome outcome;
  if (localiser_) {
    outcome = Localise(map);
  } else {
    outcome = Map(map);
    last_map_ = map;
  }
  last_ = Seen{map.utime, map.epoch, map.T_local_base};
  return outcome;
}

GlobalMapper::Outcome GlobalMapper::Localise(const LocalMapInput& map) {
  std::optional<Motion> motion;
  if (last_) motion = MotionSince(*last_, map);
  // After a restart nobody knows how the car moved between two epochs; about where it is, yes.
  if (last_ && last_->epoch != map.epoch && !odometry_.Between(last_->utime, map.utime))
    localiser_->Lose();
  if (motion) odometer_ += motion->T_from_to.position().norm();
  localiser_->Observe(map, motion);
  GlobalMapEstimate estimate = Estimate(map, localiser_->T_map_base());
  estimate.phase = localiser_->localised() ? MapPhase::kLocalised : MapPhase::kLost;
  estimate.pose_covariance = localiser_->covariance();
  estimate.cones = localiser_->cones();
  if (localiser_->localised()) CountLaps(estimate.T_map_base, odometer_, estimate.cones);
  estimate.laps = laps_;
  Outcome outcome;
  if (localiser_->localised()) {
    outcome.records.emplace_back(PlaceRecord{map.utime, map.epoch, map.T_local_base,
                                             estimate.T_map_base, estimate.pose_covariance, laps_,
                                             odometer_, lap_odometer_});
  }
  outcome.estimate = std::move(estimate);
  return outcome;
}

/// Where the local map begins anew and nobody knows well how the car moved meanwhile, the last map
/// of the old epoch is taken as a whole, so that its far cones can be known again.
void GlobalMapper::EndEpoch(const LocalMapInput& next, Outcome& outcome) {
  if (!keyframe_ || !last_map_ || last_map_->epoch == next.epoch) return;
  if (!map_.IsGap(MotionSince(*last_, next).covariance)) return;
  TrackMap::Step step = map_.Observe(*last_map_, MotionSince(*keyframe_, *last_map_), true);
  outcome.records = std::move(step.records);
  keyframe_ = Seen{last_map_->utime, last_map_->epoch, last_map_->T_local_base};
}

/// The map, with the cones marked that were seen since the last one that came: some were lost, or
/// this daemon was away.
LocalMapInput GlobalMapper::Caught(const LocalMapInput& map) const {
  LocalMapInput caught = map;
  if (!last_ || last_->epoch != map.epoch) return caught;
  for (LocalMapCone& cone : caught.cones)
    cone.seen_meanwhile = !cone.seen_now && cone.last_seen_utime > last_->utime;
  return caught;
}

GlobalMapper::Outcome GlobalMapper::Map(const LocalMapInput& map) {
  Outcome outcome;
  const bool was_closed = map_.loop_closed();
  EndEpoch(map, outcome);
  Motion motion;
  if (keyframe_) motion = MotionSince(*keyframe_, map);
  bool valid = true;
  if (!keyframe_ || map_.IsKeyframe(motion.T_from_to)) {
    TrackMap::Step step = map_.Observe(Caught(map), motion);
    outcome.records.insert(outcome.records.end(), step.records.begin(), step.records.end());
    valid = step.solved;
    keyframe_ = Seen{map.utime, map.epoch, map.T_local_base};
    motion = {};
  }
  GlobalMapEstimate estimate = Estimate(map, map_.last_pose() * motion.T_from_to);
  estimate.valid = valid;
  estimate.phase = map_.loop_closed() ? MapPhase::kLoopClosed : MapPhase::kMapping;
  estimate.pose_covariance = map_.last_covariance() + motion.covariance;
  estimate.cones = map_.Cones();
  estimate.keyframes = static_cast<int>(map_.graph().num_poses());
  CountLapsOfMap(was_closed, estimate.T_map_base,
                 map_.odometer() + motion.T_from_to.position().norm(), estimate.cones);
  estimate.laps = laps_;
  FinishLap(outcome);
  outcome.estimate = std::move(estimate);
  return outcome;
}

void GlobalMapper::FinishLap(Outcome& outcome) {
  if (laps_ == finished_laps_ || !map_.settled()) return;
  outcome.driven = map_.DrivenSince(lap_began_ - kLapOverlap);
  lap_began_ = lap_odometer_;
  finished_laps_ = laps_;
}

GlobalMapEstimate GlobalMapper::Estimate(const LocalMapInput& map, const Pose2& T_map_base) const {
  GlobalMapEstimate estimate;
  estimate.utime = map.utime;
  estimate.epoch = map.epoch;
  estimate.T_map_base = T_map_base;
  estimate.T_map_local = T_map_base * map.T_local_base.Inverse();
  return estimate;
}

void GlobalMapper::CountLapsOfMap(bool was_closed, const Pose2& T_map_base, double odometer,
                                  const std::vector<GlobalCone>& cones) {
  if (!map_.loop_closed()) return;
  if (was_closed) return CountLaps(T_map_base, odometer, cones);
  // A loop that closes past the line has passed it. A stretch of the track may pass the start the
  // other way round, and see its cones.
  const bool is_past =
      GateOf(cones).Past(T_map_base.position()) >= 0.0 && std::cos(T_map_base.yaw) > 0.0;
  if (!is_past) return CountLaps(T_map_base, odometer, cones);
  laps_ = 1;
  lap_odometer_ = odometer;
}

void GlobalMapper::CountLaps(const Pose2& T_map_base, double odometer,
                             const std::vector<GlobalCone>& cones) {
  const MapGate gate = GateOf(cones);
  const double past = gate.Past(T_map_base.position());
  const bool through = gate.Spans(T_map_base.position(), kGateMargin);
  const bool crossed = past_gate_ && *past_gate_ < 0.0 && past >= 0.0 && past < kMaxJump && through;
  past_gate_ = past;
  if (!crossed || odometer - lap_odometer_ < params_.min_lap_distance) return;
  ++laps_;
  lap_odometer_ = odometer;
}

void GlobalMapper::Resume(const PlaceRecord& place) {
  if (!localiser_) return;
  localiser_->Resume(place.T_map_base, place.covariance);
  last_ = Seen{place.utime, place.epoch, place.T_local_base};
  laps_ = static_cast<int>(place.laps);
  odometer_ = place.odometer;
  lap_odometer_ = place.lap_odometer;
}

void GlobalMapper::Replay(const std::vector<MapRecord>& records) {
  for (const MapRecord& record : records) {
    if (const auto* place = std::get_if<PlaceRecord>(&record)) {
      Resume(*place);
      continue;
    }
    const bool was_closed = map_.loop_closed();
    map_.Replay(record);
    CountLapsOfMap(was_closed, map_.last_pose(), map_.odometer(), map_.Cones());
  }
  if (map_.settled()) {
    finished_laps_ = laps_;
    lap_began_ = lap_odometer_;
  }
  if (map_.empty()) return;
  const KeyframeRecord& last = map_.last();
  keyframe_ = last_ = Seen{last.utime, last.epoch, last.T_local_base};
}

}  // namespace hairpin
