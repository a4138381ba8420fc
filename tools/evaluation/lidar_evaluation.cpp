#include "tools/evaluation/lidar_evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/report/statistics.hpp"

namespace hairpin {
namespace {

constexpr double kHalfView = std::numbers::pi / 3.0;  // +-60 degrees
constexpr double kNearest = 2.0;                      // m
constexpr double kFarthest = 20.0;                    // m
constexpr double kLooked = 15.0;                      // m: troubles farther off are no surprise
constexpr std::array<double, 8> kRangeBins{2.0, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0};
constexpr std::array<double, 6> kColourBins{0.0, 5.0, 7.5, 10.0, 12.5, 15.0};  // of the paper

bool InView(const Eigen::Vector2d& position) {
  return position.norm() >= kNearest &&
         std::abs(std::atan2(position.y(), position.x())) <= kHalfView;
}

// The ground about a cone: the median of what lies around it but is not its own.
std::optional<float> GroundAbout(const PointCloud& cloud, const std::vector<uint32_t>& about,
                                 const Eigen::Vector2f& cone) {
  for (const float outer : {0.8f, 1.5f, 3.0f}) {
    std::vector<float> heights;
    for (const uint32_t i : about) {
      const float distance = (Eigen::Vector2f(cloud.x[i], cloud.y[i]) - cone).norm();
      if (distance > kCountedRadius && distance < outer) heights.push_back(cloud.z[i]);
    }
    if (heights.size() < 5) continue;
    const auto middle = heights.begin() + static_cast<ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    return *middle;
  }
  return std::nullopt;
}

nlohmann::json Share(double part, double whole) {
  return whole > 0.0 ? nlohmann::json(part / whole) : nlohmann::json();
}

}  // namespace

void CountReturns(const PointCloud& cloud, std::vector<ScannedCone>& cones) {
  std::vector<uint32_t> about;
  for (ScannedCone& cone : cones) {
    const Eigen::Vector2f position = cone.position.cast<float>();
    about.clear();
    for (uint32_t i = 0; i < cloud.size(); ++i) {
      if (std::abs(cloud.x[i] - position.x()) < 3.0f && std::abs(cloud.y[i] - position.y()) < 3.0f)
        about.push_back(i);
    }
    const std::optional<float> ground = GroundAbout(cloud, about, position);
    cone.returns = 0;
    if (!ground) continue;
    for (const uint32_t i : about) {
      const bool within =
          (Eigen::Vector2f(cloud.x[i], cloud.y[i]) - position).norm() <= kCountedRadius;
      cone.returns += within && cloud.z[i] > *ground + kCountedHeight;
    }
  }
}

ScanMatch MatchScan(const std::vector<ScannedCone>& cones,
                    const std::vector<LidarDetection>& detections) {
  struct Pair {
    double distance;
    size_t cone, detection;
  };
  std::vector<Pair> pairs;
  ScanMatch match{std::vector<int>(cones.size(), -1), std::vector<int>(detections.size(), -1)};
  for (size_t d = 0; d < detections.size(); ++d) {
    for (size_t c = 0; c < cones.size(); ++c) {
      const double distance = (detections[d].position - cones[c].position).norm();
      if (distance > kMatchDistance) continue;
      pairs.push_back({distance, c, d});
      match.cone_of_detection[d] = -2;
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  for (const Pair& pair : pairs) {
    if (match.detection_of_cone[pair.cone] >= 0 || match.cone_of_detection[pair.detection] >= 0)
      continue;
    match.detection_of_cone[pair.cone] = static_cast<int>(pair.detection);
    match.cone_of_detection[pair.detection] = static_cast<int>(pair.cone);
  }
  return match;
}

void LidarFigures::Add(const std::vector<ScannedCone>& cones,
                       const std::vector<LidarDetection>& detections, const Eigen::Vector2d& sensor,
                       const std::vector<double>& ms) {
  Trouble& trouble = troubles_.emplace_back(Trouble{scans_, 0, 0});
  ++scans_;
  const ScanMatch match = MatchScan(cones, detections);
  for (size_t c = 0; c < cones.size(); ++c) {
    if (!InView(cones[c].position) || cones[c].position.norm() > kFarthest) continue;
    Seen seen{cones[c].position.norm(), cones[c].returns, false, cones[c].colour};
    if (match.detection_of_cone[c] >= 0) {
      const LidarDetection& found = detections[static_cast<size_t>(match.detection_of_cone[c])];
      const Eigen::Vector2d u = (cones[c].position - sensor).normalized();
      const Eigen::Vector2d error = found.position - cones[c].position;
      seen.found = true;
      seen.along = error.dot(u);
      seen.across = u.x() * error.y() - u.y() * error.x();
      seen.detected = found.colour;
    }
    trouble.missed += !seen.found && seen.returns >= kFewestReturns && seen.range <= kLooked;
    seen_.push_back(seen);
  }
  for (size_t d = 0; d < detections.size(); ++d) {
    reported_.push_back({detections[d].position.norm(), InView(detections[d].position),
                         match.cone_of_detection[d] == -1});
    const Reported& reported = reported_.back();
    trouble.wrong += reported.in_view && reported.is_false && reported.range <= kLooked;
  }
  ms_.resize(std::max(ms_.size(), ms.size()));
  for (size_t i = 0; i < ms.size(); ++i) ms_[i].push_back(ms[i]);
}

std::optional<double> LidarFigures::Recall(double from, double to) const {
  double found = 0.0, all = 0.0;
  for (const Seen& seen : seen_) {
    if (seen.returns < kFewestReturns || seen.range < from || seen.range >= to) continue;
    all += 1.0;
    found += seen.found;
  }
  return all > 0.0 ? std::optional(found / all) : std::nullopt;
}

std::optional<double> LidarFigures::Precision(double to, bool everywhere) const {
  double right = 0.0, all = 0.0;
  for (const Reported& reported : reported_) {
    if (reported.range > to || !(everywhere || reported.in_view)) continue;
    all += 1.0;
    right += !reported.is_false;
  }
  return all > 0.0 ? std::optional(right / all) : std::nullopt;
}

nlohmann::json LidarFigures::RangeBin(double from, double to) const {
  std::vector<double> along, across, error;
  double cones = 0.0;
  for (const Seen& seen : seen_) {
    if (seen.range < from || seen.range >= to) continue;
    cones += seen.returns >= kFewestReturns;
    if (!seen.found || seen.returns < kFewestReturns) continue;
    along.push_back(seen.along);
    across.push_back(seen.across);
    error.push_back(std::hypot(seen.along, seen.across));
  }
  const auto spread = [](const std::vector<double>& values) -> std::optional<double> {
    if (values.empty()) return std::nullopt;
    return 0.5 * (*Percentile(values, 84.0) - *Percentile(values, 16.0));
  };
  double false_ones = 0.0;
  for (const Reported& reported : reported_)
    false_ones +=
        reported.in_view && reported.is_false && reported.range >= from && reported.range < to;
  return {{"from_m", from},
          {"to_m", to},
          {"cones", cones},
          {"recall", OrNull(Recall(from, to))},
          {"false_per_scan", Share(false_ones, scans_)},
          {"error_median_m", OrNull(Percentile(error, 50.0))},
          {"bias_along_m", OrNull(Percentile(along, 50.0))},
          {"bias_across_m", OrNull(Percentile(across, 50.0))},
          {"spread_along_m", OrNull(spread(along))},
          {"spread_across_m", OrNull(spread(across))}};
}

nlohmann::json LidarFigures::ByReturns() const {
  constexpr std::array<int, 9> kFrom{0, 1, 2, 3, 4, 6, 10, 20, 1'000'000};
  nlohmann::json bins = nlohmann::json::array();
  for (size_t i = 0; i + 1 < kFrom.size(); ++i) {
    double found = 0.0, all = 0.0;
    for (const Seen& seen : seen_) {
      if (seen.range > 15.0 || seen.returns < kFrom[i] || seen.returns >= kFrom[i + 1]) continue;
      all += 1.0;
      found += seen.found;
    }
    bins.push_back({{"returns_from", kFrom[i]}, {"cones", all}, {"recall", Share(found, all)}});
  }
  return bins;
}

LidarFigures::ColourBins LidarFigures::Colours() const {
  ColourBins bins;
  for (size_t i = 0; i + 1 < kColourBins.size(); ++i) {
    double right = 0.0, wrong = 0.0, unknown = 0.0;
    for (const Seen& seen : seen_) {
      if (!seen.found || seen.range < kColourBins[i] || seen.range >= kColourBins[i + 1]) continue;
      if (seen.colour != ConeColour::kBlue && seen.colour != ConeColour::kYellow) continue;
      const ConeColour detected = MostProbable(seen.detected);
      if (detected == ConeColour::kUnknown) {
        unknown += 1.0;
      } else {
        (detected == seen.colour ? right : wrong) += 1.0;
      }
    }
    bins.accuracy.push_back(Share(right, right + wrong));
    bins.unknown.push_back(Share(unknown, right + wrong + unknown));
  }
  return bins;
}

nlohmann::json LidarFigures::ScansToLookAt() const {
  std::vector<Trouble> worst = troubles_;
  std::stable_sort(worst.begin(), worst.end(), [](const Trouble& a, const Trouble& b) {
    return a.missed + a.wrong > b.missed + b.wrong;
  });
  nlohmann::json list = nlohmann::json::array();
  for (size_t i = 0; i < std::min<size_t>(worst.size(), 10); ++i)
    list.push_back(
        {{"scan", worst[i].scan}, {"missed", worst[i].missed}, {"false", worst[i].wrong}});
  return list;
}

nlohmann::json LidarFigures::ToJson() const {
  std::vector<double> errors;
  for (const Seen& seen : seen_) {
    if (seen.found && seen.returns >= kFewestReturns && seen.range <= 15.0)
      errors.push_back(std::hypot(seen.along, seen.across));
  }
  double false_ones = 0.0;
  for (const Reported& reported : reported_)
    false_ones += reported.is_false && reported.range <= kFarthest;
  nlohmann::json ranges = nlohmann::json::array();
  for (size_t i = 0; i + 1 < kRangeBins.size(); ++i)
    ranges.push_back(RangeBin(kRangeBins[i], kRangeBins[i + 1]));
  nlohmann::json stages;
  constexpr std::array<const char*, kNumDetectorStages + 1> kNames{"ground", "clusters", "feet",
                                                                   "cones", "whole"};
  for (size_t i = 0; i < kNames.size(); ++i)
    stages[kNames[i]] = i < ms_.size() ? PercentilesJson(ms_[i]) : nlohmann::json();
  const auto whole = ms_.size() == kNames.size() ? Percentile(ms_.back(), 50.0) : std::nullopt;
  const ColourBins colours = Colours();
  return {{"scans", scans_},
          {"recall_0_10m", OrNull(Recall(kNearest, 10.0))},
          {"recall_10_15m", OrNull(Recall(10.0, 15.0))},
          {"recall_0_12m", OrNull(Recall(kNearest, 12.0))},
          {"recall_12_18m", OrNull(Recall(12.0, 18.0))},
          {"precision_15m", OrNull(Precision(15.0, false))},
          {"precision_15m_all_around", OrNull(Precision(15.0, true))},
          {"false_per_scan", Share(false_ones, scans_)},
          {"position_error_median_m", OrNull(Percentile(errors, 50.0))},
          {"colour_accuracy", colours.accuracy},
          {"colour_unknown", colours.unknown},
          {"ms_median", OrNull(whole)},
          {"stages_ms", stages},
          {"by_range", ranges},
          {"by_returns", ByReturns()},
          {"scans_to_look_at", ScansToLookAt()}};
}

}  // namespace hairpin
