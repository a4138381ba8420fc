#include "daemons/path_tracker/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

void Check(const SpeedProfileParams& params) {
  constexpr Require require("SpeedProfile");
  require(params.max_speed > 0.0, "max_speed_mps must be > 0");
  require(params.lateral_acceleration > 0.0, "lateral_acceleration_mps2 must be > 0");
  require(params.braking > 0.0, "braking_mps2 must be > 0");
  require(params.stop_margin >= 0.0, "stop_margin_m must be >= 0");
  require(params.rise >= 0.0, "the rise must be >= 0");
}

}  // namespace

SpeedProfile::SpeedProfile(const std::vector<double>& curvature, double spacing, double seen_length,
                           const SpeedProfileParams& params)
    : params_(params), spacing_(spacing), curvature_(curvature) {
  Check(params);
  if (curvature.size() < 2 || !(spacing > 0.0) || !(seen_length >= 0.0)) {
    throw std::invalid_argument(
        "SpeedProfile: needs two samples, spacing > 0 and seen length >= 0");
  }
  const double length = spacing * static_cast<double>(curvature.size() - 1);
  stop_at_ = std::min(seen_length, length) - params.stop_margin;

  LimitCorners();
  BrakeBackward(corners_, corners_.size() - 1);

  stop_ = corners_;
  const double last = std::clamp(stop_at_ / spacing, 0.0, static_cast<double>(stop_.size() - 2));
  const auto before = static_cast<size_t>(last);  // the sample at or before the place to stand
  for (size_t i = before; i < stop_.size(); ++i) {
    const double left = stop_at_ - spacing * static_cast<double>(i);
    stop_[i] = std::min(stop_[i], 2.0 * params.braking * left);
  }
  BrakeBackward(stop_, before);
}

SpeedProfile::SpeedProfile(const std::vector<double>& curvature, double spacing,
                           const std::vector<double>& planned, const SpeedProfileParams& params)
    : params_(params), spacing_(spacing), curvature_(curvature) {
  Check(params);
  if (curvature.size() < 2 || !(spacing > 0.0) || planned.size() != curvature.size()) {
    throw std::invalid_argument(
        "SpeedProfile: needs two samples, spacing > 0 and a speed for each sample");
  }
  stop_at_ = std::numeric_limits<double>::infinity();
  LimitCorners();
  for (size_t i = 0; i < planned.size(); ++i)
    corners_[i] = std::min(corners_[i], planned[i] * planned[i]);
  BrakeBackward(corners_, corners_.size() - 1);
  stop_ = corners_;
}

void SpeedProfile::LimitCorners() {
  corners_.reserve(curvature_.size());
  const double most = params_.max_speed * params_.max_speed;
  for (const double k : curvature_) {
    const double lateral = params_.lateral_acceleration;
    corners_.push_back(std::abs(k) * most > lateral ? lateral / std::abs(k) : most);
  }
}

void SpeedProfile::BrakeBackward(std::vector<double>& squared_speed, size_t from) const {
  for (size_t i = from; i-- > 0;) {
    const double next = std::max(squared_speed[i + 1], 0.0);
    const double used = next * curvature_[i + 1] / params_.lateral_acceleration;
    const double braking = params_.braking * std::sqrt(std::max(0.0, 1.0 - used * used));
    squared_speed[i] = std::min(squared_speed[i], next + 2.0 * braking * spacing_);
  }
}

SpeedProfile::Limit SpeedProfile::Stop(double s) const {
  if (s >= stop_at_) return {0.0, -params_.braking};
  return At(stop_, s);
}

SpeedProfile::Limit SpeedProfile::At(const std::vector<double>& squared_speed, double s) const {
  const double position = std::clamp(s / spacing_, 0.0, static_cast<double>(curvature_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), curvature_.size() - 2);
  const double t = position - static_cast<double>(i);
  const double squared = (1.0 - t) * squared_speed[i] + t * squared_speed[i + 1];
  const double slope = 0.5 * (squared_speed[i + 1] - squared_speed[i]) / spacing_;
  return {std::sqrt(std::max(squared, 0.0)), std::clamp(slope, -params_.braking, params_.rise)};
}

}  // namespace hairpin
