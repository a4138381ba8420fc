#include "daemons/path_tracker/race_guide.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {
namespace {

// The place on the line is looked for about the last one; a new line begins a little behind.
constexpr double kSearchBehind = 1.0;  // m
constexpr double kSearchAhead = 6.0;   // m
constexpr double kFirstSearch = 15.0;  // m
constexpr double kMaxStep = 0.1;       // s: the weight changes for no longer than this at once

void Check(const RaceGuideParams& params) {
  constexpr Require require("RaceGuide");
  require(params.body_width > 0.0, "body_width_m must be > 0");
  require(params.max_age > 0.0, "max_data_age_s must be > 0");
  require(params.max_position_sigma > 0.0, "race_max_position_sigma_m must be > 0");
  require(params.max_yaw_sigma > 0.0, "race_max_yaw_sigma_rad must be > 0");
  require(params.max_jump > 0.0, "race_max_jump_m must be > 0");
  require(params.overlap >= 0.0, "race_overlap_m must be >= 0");
  require(params.checked_length > 0.0, "race_checked_length_m must be > 0");
  require(params.healthy_for >= 0.0, "race_healthy_for_s must be >= 0");
  require(params.blend_time > 0.0, "race_blend_s must be > 0");
}

// Speeds of points evenly along a line, for `count` samples evenly along it.
std::vector<double> Spread(const std::vector<double>& speeds, double used, size_t count) {
  std::vector<double> spread;
  for (size_t i = 0; i < count; ++i) {
    const double at = used * static_cast<double>(i) / static_cast<double>(count - 1);
    const size_t before = std::min(static_cast<size_t>(at), speeds.size() - 2);
    spread.push_back(
        std::lerp(speeds[before], speeds[before + 1], at - static_cast<double>(before)));
  }
  return spread;
}

}  // namespace

RaceGuide::RaceGuide(const RaceGuideParams& params) : params_(params) { Check(params); }

std::string RaceGuide::Take(const RaceLineInput& input, const Pose2& T_own_base,
                            const Pose2& T_own_now) {
  if (input.utime <= taken_utime_) return "no newer than the last line";
  if (input.points.size() < 2 || input.points.size() != input.speeds.size()) {
    return "needs two points, and a speed for each";
  }
  const Pose2 T_own_map = T_own_base * input.T_map_base.Inverse();
  std::vector<Eigen::Vector2d> points;
  double length = 0.0;
  for (const Eigen::Vector2d& point : input.points) {
    points.push_back(T_own_map * point);
    if (points.size() > 1) length += (points.back() - points[points.size() - 2]).norm();
  }
  try {
    ReferencePath path(points, params_.path);
    const double share = std::min(1.0, params_.path.max_length / length);
    const auto used = share * static_cast<double>(points.size() - 1);
    SpeedProfile profile(path.curvature(), path.spacing(),
                         Spread(input.speeds, used, path.curvature().size()), params_.speed);
    Line line{input.utime, std::move(path), std::move(profile), 0.0};
    line.progress = line.path.Locate(T_own_now.position(), 0.0, kFirstSearch).s;
    taken_utime_ = input.utime;
    sure_ = input.position_sigma <= params_.max_position_sigma &&
            input.yaw_sigma <= params_.max_yaw_sigma && !Jumps(line, T_own_now);
    // While the car moves over to TRACK it comes from the last good line.
    if (sure_ || weight_ <= 0.0) line_.emplace(std::move(line));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

bool RaceGuide::Jumps(const Line& line, const Pose2& T_own_now) const {
  if (!line_ || weight_ <= 0.0) return false;
  const ReferencePath::Location before = Locate(T_own_now.position());
  const ReferencePath::Location after =
      line.path.Locate(T_own_now.position(), line.progress, line.progress);
  return std::abs(after.lateral_error - before.lateral_error) > params_.max_jump;
}

bool RaceGuide::KeepsBetweenBoundaries(const SeenTrack& track) const {
  const double to = std::min(line_->progress + params_.checked_length, line_->path.length());
  for (double s = line_->progress; s < to; s += line_->path.spacing()) {
    const Eigen::Vector2d point = line_->path.PointAt(s);
    size_t nearest = 0;
    for (size_t i = 1; i < track.points.size(); ++i) {
      if ((track.points[i] - point).norm() < (track.points[nearest] - point).norm()) nearest = i;
    }
    if (nearest + 1 >= track.points.size()) return true;  // TRACK has seen no farther
    const double off = std::abs(track.path->Locate(point, 0.0, track.path->length()).lateral_error);
    if (off + 0.5 * params_.body_width > 0.5 * track.widths[nearest] + params_.overlap) {
      return false;
    }
  }
  return true;
}

void RaceGuide::Compare(const SeenTrack& track) {
  between_ = line_ && KeepsBetweenBoundaries(track);
}

void RaceGuide::Update(int64_t utime, const Pose2& T_own_base, std::optional<int64_t> track_utime) {
  const double dt = last_utime_ == 0 ? 0.0 : std::min(SecondsBetween(last_utime_, utime), kMaxStep);
  last_utime_ = utime;
  if (line_) line_->progress = Locate(T_own_base.position()).s;
  const auto young = [&](int64_t then) { return SecondsBetween(then, utime) <= params_.max_age; };
  const bool healthy =
      line_ && sure_ && between_ && young(taken_utime_) && track_utime && young(*track_utime);
  if (!healthy) healthy_since_.reset();
  if (healthy && !healthy_since_) healthy_since_ = utime;
  const bool follow = healthy && SecondsBetween(*healthy_since_, utime) >= params_.healthy_for;
  weight_ = std::clamp(weight_ + (follow ? dt : -dt) / params_.blend_time, 0.0, 1.0);
}

double RaceGuide::weight() const { return weight_ * weight_ * (3.0 - 2.0 * weight_); }

ReferencePath::Location RaceGuide::Locate(const Eigen::Vector2d& point_own) const {
  const double s = line_->progress;
  return line_->path.Locate(point_own, s - kSearchBehind, s + kSearchAhead);
}

SpeedProfile::Limit RaceGuide::Speed(double ahead) const {
  return line_->profile.Corners(line_->progress + ahead);
}

}  // namespace hairpin
