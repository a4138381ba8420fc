#include "tools/surveying/survey.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr std::array<std::pair<PointKind, const char*>, 6> kNames{
    {{PointKind::kBlue, "blue"},
     {PointKind::kYellow, "yellow"},
     {PointKind::kOrange, "orange"},
     {PointKind::kOrangeLarge, "orange_large"},
     {PointKind::kStart, "start"},
     {PointKind::kAhead, "ahead"}}};

std::string Centimetres(double metres) {
  return std::to_string(static_cast<int>(std::lround(100.0 * metres))) + " cm";
}

double HorizontalSigma(const Eigen::Vector3d& sigma) { return std::max(sigma.x(), sigma.y()); }

std::string ProblemOf(const GnssFix& fix, const SurveyParams& params) {
  if (fix.type == FixType::kFloat) return "float solution";
  if (fix.type != FixType::kRtk) return "no RTK solution";
  if (HorizontalSigma(fix.position_sigma) > params.max_sigma_m)
    return "too uncertain: " + Centimetres(HorizontalSigma(fix.position_sigma));
  return {};
}

}  // namespace

std::string NameOf(PointKind kind) {
  return std::find_if(kNames.begin(), kNames.end(),
                      [kind](const auto& known) { return known.first == kind; })
      ->second;
}

std::optional<PointKind> PointKindFromName(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (name == known) return kind;
  }
  return std::nullopt;
}

std::optional<ConeColour> ColourOf(PointKind kind) {
  switch (kind) {
    case PointKind::kBlue:
      return ConeColour::kBlue;
    case PointKind::kYellow:
      return ConeColour::kYellow;
    case PointKind::kOrange:
      return ConeColour::kOrange;
    case PointKind::kOrangeLarge:
      return ConeColour::kOrangeLarge;
    case PointKind::kStart:
    case PointKind::kAhead:
      break;
  }
  return std::nullopt;
}

SurveyAnswer Survey::Refuse(const std::string& why) {
  const std::string name = NameOf(under_way_->kind);
  under_way_.reset();
  return {.accepted = {}, .is_undone = false, .word = name + " refused: " + why};
}

SurveyAnswer Survey::Press(PointKind kind, int64_t now) {
  if (under_way_) return {{}, false, "wait: " + NameOf(under_way_->kind) + " is being averaged"};
  under_way_ = UnderWay{kind, {}};
  if (!last_fix_ || SecondsBetween(last_fix_now_, now) > params_.stale_s)
    return Refuse("stale: no fix from the receiver");
  const std::string problem = ProblemOf(*last_fix_, params_);
  if (!problem.empty()) return Refuse(problem);
  return {{}, false, NameOf(kind) + ": stand still"};
}

SurveyAnswer Survey::Undo() {
  if (under_way_) return Refuse("by yourself");
  if (points_.empty()) return {{}, false, "nothing to undo"};
  const std::string name = NameOf(points_.back().kind);
  points_.pop_back();
  return {{}, true, name + " taken back"};
}

void Survey::Restore(const SurveyedPoint& point) {
  if (!plane_) plane_.emplace(point.position);
  points_.push_back(point);
}

SurveyAnswer Survey::Wait(int64_t now) {
  if (under_way_ && SecondsBetween(last_fix_now_, now) > params_.stale_s)
    return Refuse("stale: the receiver fell silent");
  return {};
}

SurveyAnswer Survey::Add(const GnssFix& fix, int64_t now) {
  last_fix_ = fix;
  last_fix_now_ = now;
  if (!under_way_) return {};
  const std::string problem = ProblemOf(fix, params_);
  if (!problem.empty()) return Refuse(problem);
  if (!plane_) plane_.emplace(fix.position);
  std::vector<GnssFix>& fixes = under_way_->fixes;
  fixes.push_back(fix);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const GnssFix& other : fixes)
    mean += ToEnu(other.position) / static_cast<double>(fixes.size());
  for (const GnssFix& other : fixes) {
    if ((ToEnu(other.position) - mean).head<2>().norm() > params_.max_scatter_m)
      return Refuse("the antenna moved");
  }
  const bool is_long = SecondsBetween(fixes.front().utime, fix.utime) >= params_.averaging_s;
  const bool are_many = fixes.size() >= static_cast<size_t>(params_.min_fixes);
  return is_long && are_many ? Finish() : SurveyAnswer{};
}

SurveyAnswer Survey::Finish() {
  const std::vector<GnssFix>& fixes = under_way_->fixes;
  const auto count = static_cast<double>(fixes.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const GnssFix& fix : fixes) mean += ToEnu(fix.position) / count;
  // What the receiver states is common to fixes seconds apart: averaging only lowers the scatter.
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (const GnssFix& fix : fixes) {
    const Eigen::Vector3d off = ToEnu(fix.position) - mean;
    variance += (fix.position_sigma.cwiseAbs2() + off.cwiseAbs2() / count) / count;
  }
  SurveyedPoint point{.kind = under_way_->kind,
                      .utime = fixes.back().utime,
                      .position = plane_->ToGeodetic(mean),
                      .sigma = variance.cwiseSqrt(),
                      .fixes = static_cast<int>(fixes.size())};
  if (const std::optional<size_t> other = Doubled(point.kind, point.position))
    return Refuse("doubled: number " + std::to_string(*other + 1) + " stands here");
  points_.push_back(point);
  under_way_.reset();
  return {point, false,
          std::to_string(points_.size()) + " " + NameOf(point.kind) + " +- " +
              Centimetres(HorizontalSigma(point.sigma))};
}

Eigen::Vector3d Survey::ToEnu(const GeodeticPoint& point) const { return plane_->ToEnu(point); }

std::optional<size_t> Survey::Doubled(PointKind kind, const GeodeticPoint& position) const {
  if (!ColourOf(kind)) return std::nullopt;
  for (size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d apart = ToEnu(points_[i].position) - ToEnu(position);
    if (ColourOf(points_[i].kind) && apart.head<2>().norm() < params_.min_spacing_m) return i;
  }
  return std::nullopt;
}

}  // namespace hairpin
