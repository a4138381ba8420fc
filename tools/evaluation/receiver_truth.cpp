#include "tools/evaluation/receiver_truth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/car.hpp"
#include "common/clock.hpp"
#include "common/geometry.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/simulator/timing_lines.hpp"

namespace hairpin {
namespace {

constexpr const char* kNoFix = "no_fix";
constexpr const char* kSingle = "single";
constexpr const char* kDifferential = "differential";
constexpr const char* kFloat = "float";
constexpr const char* kStale = "stale";
constexpr const char* kNoHeading = "no_heading";
constexpr const char* kUncertain = "uncertain";
constexpr const char* kLone = "lone";

/// Why a solution is no truth; null where it may be one.
const char* ProblemOf(const gnss_t& fix, const ReceiverTruthParams& params) {
  switch (fix.fix) {
    case gnss_t::FIX_RTK:
      break;
    case gnss_t::FIX_FLOAT:
      return kFloat;
    case gnss_t::FIX_DIFFERENTIAL:
      return kDifferential;
    case gnss_t::FIX_SINGLE:
      return kSingle;
    default:
      return kNoFix;
  }
  if (fix.heading_valid == 0) return kNoHeading;
  const double sigma = std::max(fix.position_sigma_m[0], fix.position_sigma_m[1]);
  const bool is_certain =
      sigma <= params.max_position_sigma && fix.heading_sigma_rad <= params.max_heading_sigma;
  return is_certain ? nullptr : kUncertain;
}

/// True for one that is not newer than the last, or says the same again to the last digit.
bool IsStale(const gnss_t& last, const gnss_t& fix) {
  const auto same = [](const auto& a, const auto& b) {
    return std::equal(std::begin(a), std::end(a), std::begin(b));
  };
  return fix.utime <= last.utime ||
         (same(last.position_enu_m, fix.position_enu_m) &&
          same(last.velocity_enu_mps, fix.velocity_enu_mps) && last.heading_rad == fix.heading_rad);
}

/// By the headings of those of `a`, `b` and `c` that are near in time to `b`; the outer ones may be
/// null.
std::optional<double> YawRate(const gnss_t* a, const gnss_t& b, const gnss_t* c) {
  const auto is_near = [](const gnss_t* from, const gnss_t* to) {
    return from != nullptr && to != nullptr &&
           SecondsBetween(from->utime, to->utime) <= kMaxTruthGap;
  };
  const gnss_t* from = is_near(a, &b) ? a : &b;
  const gnss_t* to = is_near(&b, c) ? c : &b;
  if (from == to) return std::nullopt;
  return WrapAngle(to->heading_rad - from->heading_rad) / SecondsBetween(from->utime, to->utime);
}

truth_t ToTruth(const gnss_t& fix, double yaw_rate, const Eigen::Vector2d& antenna) {
  const Eigen::Matrix2d R_map_base = Pose2{0.0, 0.0, fix.heading_rad}.rotation();
  const Eigen::Vector2d position =
      Eigen::Vector2d(fix.position_enu_m[0], fix.position_enu_m[1]) - R_map_base * antenna;
  const Eigen::Vector2d of_antenna =
      R_map_base.transpose() * Eigen::Vector2d(fix.velocity_enu_mps[0], fix.velocity_enu_mps[1]);
  truth_t truth{};
  truth.utime = fix.utime;
  truth.x_m = position.x();
  truth.y_m = position.y();
  truth.yaw_rad = WrapAngle(fix.heading_rad);
  truth.vx_mps = of_antenna.x() + yaw_rate * antenna.y();
  truth.vy_mps = of_antenna.y() - yaw_rate * antenna.x();
  truth.yaw_rate_radps = yaw_rate;
  return truth;
}

/// Of the way from one to the next.
double Way(const truth_t& from, const truth_t& to) {
  const Eigen::Vector2d way(to.x_m - from.x_m, to.y_m - from.y_m);
  if (SecondsBetween(from.utime, to.utime) > kMaxTruthGap) return way.norm();
  const double yaw = from.yaw_rad + 0.5 * WrapAngle(to.yaw_rad - from.yaw_rad);
  return way.dot(Eigen::Vector2d(std::cos(yaw), std::sin(yaw)));
}

/// Distances, laps, and where nothing is known.
void Follow(const Track& track, ReceiverTruth& result) {
  TimingLines lines(track);
  for (size_t i = 1; i < result.truth.size(); ++i) {
    const truth_t& last = result.truth[i - 1];
    truth_t& next = result.truth[i];
    next.distance_m = last.distance_m + Way(last, next);
    lines.Cross({last.x_m, last.y_m}, {next.x_m, next.y_m});
    next.lap = lines.laps();
    if (SecondsBetween(last.utime, next.utime) > kMaxTruthGap)
      result.gaps.push_back({last.utime, next.utime});
  }
}

}  // namespace

ReceiverTruthParams LoadReceiverTruthParams(const Config& config) {
  ReceiverTruthParams params;
  params.antenna = LoadCar(config).gnss_position;
  params.max_position_sigma = config.Number("max_position_sigma_m", {0.001, 1.0});
  params.max_heading_sigma = config.Number("max_heading_sigma_rad", {1e-4, 0.5});
  config.Finish();
  return params;
}

ReceiverTruth TruthOfReceiver(const std::vector<gnss_t>& fixes, const Track& track,
                              const ReceiverTruthParams& params) {
  ReceiverTruth result;
  for (const char* reason :
       {kNoFix, kSingle, kDifferential, kFloat, kStale, kNoHeading, kUncertain, kLone})
    result.left_out[reason] = 0;
  std::vector<const gnss_t*> solutions;
  for (const gnss_t& fix : fixes) {
    const char* problem = ProblemOf(fix, params);
    if (problem == nullptr && !solutions.empty() && IsStale(*solutions.back(), fix))
      problem = kStale;
    if (problem == nullptr) {
      solutions.push_back(&fix);
    } else {
      ++result.left_out[problem];
    }
  }
  for (size_t i = 0; i < solutions.size(); ++i) {
    const gnss_t* before = i > 0 ? solutions[i - 1] : nullptr;
    const gnss_t* after = i + 1 < solutions.size() ? solutions[i + 1] : nullptr;
    if (const auto yaw_rate = YawRate(before, *solutions[i], after)) {
      result.truth.push_back(ToTruth(*solutions[i], *yaw_rate, params.antenna));
    } else {
      ++result.left_out[kLone];
    }
  }
  Follow(track, result);
  return result;
}

}  // namespace hairpin
