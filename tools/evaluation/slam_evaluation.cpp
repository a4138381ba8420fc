#include "tools/evaluation/slam_evaluation.hpp"

#include <cmath>
#include <numeric>

#include "common/clock.hpp"
#include "tools/report/statistics.hpp"

namespace hairpin {
namespace {

constexpr double kSurprise = 1.0;  // squared whitened residual of a known landmark

class Drive {
 public:
  Drive(const SlamDataset& dataset, const GraphParams& params)
      : graph_(params), landmark_of_(dataset.num_landmarks) {}

  /// True where a known landmark was not where it was seen.
  bool Add(const SlamDataset::Step& step, bool first) {
    if (!first) graph_.AddPose(step.odometry);
    bool surprise = false;
    for (const SlamDataset::Sighting& sighting : step.sightings) {
      auto& landmark = landmark_of_[sighting.landmark];
      if (!landmark) {
        landmark = graph_.AddLandmark(graph_.newest_pose() * sighting.measurement.position);
      } else {
        surprise |= graph_.SquaredResidual(*landmark, sighting.measurement) > kSurprise;
      }
      graph_.AddSighting(*landmark, sighting.measurement);
    }
    return surprise;
  }

  PoseLandmarkGraph& graph() { return graph_; }

  /// Half the sum of squared whitened residuals, each as it was measured.
  double Cost(const SlamDataset& dataset) const {
    double sum = 0.0;
    for (size_t i = 0; i < dataset.steps.size(); ++i) {
      const SlamDataset::Step& step = dataset.steps[i];
      if (i > 0) sum += SquaredResidual(step.odometry, i);
      for (const SlamDataset::Sighting& sighting : step.sightings)
        sum += SquaredResidual(sighting, i);
    }
    return 0.5 * sum;
  }

 private:
  double SquaredResidual(const OdometryMeasurement& odometry, size_t to) const {
    const Pose2 a = graph_.pose(to - 1), b = graph_.pose(to);
    const double from_x[] = {a.x, a.y, a.yaw}, to_x[] = {b.x, b.y, b.yaw};
    Eigen::Vector3d r;
    OdometryResidual(odometry, from_x, to_x, r.data(), nullptr, nullptr);
    return r.squaredNorm();
  }

  double SquaredResidual(const SlamDataset::Sighting& sighting, size_t from) const {
    const Eigen::Vector2d is =
        graph_.pose(from).Inverse() * graph_.landmark(*landmark_of_[sighting.landmark]);
    const Eigen::Vector2d& seen = sighting.measurement.position;
    if (!sighting.polar_sigma)
      return (sighting.measurement.sqrt_information * (is - seen)).squaredNorm();
    const Eigen::Vector2d error(
        WrapAngle(std::atan2(is.y(), is.x()) - std::atan2(seen.y(), seen.x())),
        is.norm() - seen.norm());
    return error.cwiseQuotient(*sighting.polar_sigma).squaredNorm();
  }

  PoseLandmarkGraph graph_;
  std::vector<std::optional<size_t>> landmark_of_;
};

}  // namespace

SlamReport EvaluateSlam(const SlamDataset& dataset, const GraphParams& params,
                        int full_solve_steps) {
  const MonotonicClock clock;
  SlamReport report;
  Drive drive(dataset, params);
  int since_full = 0;
  for (size_t i = 0; i < dataset.steps.size(); ++i) {
    const int64_t start = clock.NowMicros();
    const bool surprise = drive.Add(dataset.steps[i], i == 0);
    const bool last = i + 1 == dataset.steps.size();
    if (surprise || last || ++since_full >= full_solve_steps) {
      drive.graph().SolveAll();
      ++report.full_solves;
      since_full = 0;
    } else {
      drive.graph().SolveWindow();
    }
    report.step_ms.push_back(1e3 * SecondsBetween(start, clock.NowMicros()));
  }
  report.total_s = std::accumulate(report.step_ms.begin(), report.step_ms.end(), 0.0) * 1e-3;
  report.final_cost = drive.Cost(dataset);
  return report;
}

nlohmann::json ToJson(const SlamReport& report) {
  const auto mean =
      report.total_s * 1e3 / static_cast<double>(std::max<size_t>(1, report.step_ms.size()));
  return {{"final_cost", report.final_cost},
          {"steps", report.step_ms.size()},
          {"full_solves", report.full_solves},
          {"ms_mean", mean},
          {"ms_p99", OrNull(Percentile(report.step_ms, 99.0))},
          {"ms_max", OrNull(Percentile(report.step_ms, 100.0))},
          {"total_s", report.total_s}};
}

}  // namespace hairpin
