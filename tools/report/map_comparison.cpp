#include "tools/report/map_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/report/true_track.hpp"

namespace hairpin {
namespace {

constexpr double kFirstIcpGate = 3.0;  // m: cones of a side stand some 3 to 5 m apart
constexpr double kIcpGateShrink = 0.9;
constexpr int kMaxIcpIterations = 100;
constexpr double kIcpConverged = 1e-9;

using Points = std::vector<Eigen::Vector2d>;

struct Neighbour {
  size_t index = 0;
  double distance = std::numeric_limits<double>::infinity();
};

Neighbour Nearest(const Points& points, const Eigen::Vector2d& point) {
  Neighbour nearest;
  for (size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i] - point).norm();
    if (distance < nearest.distance) nearest = {i, distance};
  }
  return nearest;
}

bool IsSame(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() < kIcpConverged &&
         std::abs(WrapAngle(a.yaw - b.yaw)) < kIcpConverged;
}

ConeColour MostProbableOf(const float (&probability)[kNumConeColours]) {
  ColourDistribution distribution;
  std::copy(std::begin(probability), std::end(probability), distribution.begin());
  return MostProbable(distribution);
}

Points TruePositions(const RunLog& log) {
  Points truth;
  for (const TrueCone& cone : TrueCones(*log.truth_track)) truth.push_back(cone.position);
  return truth;
}

struct LocalMapCone {
  EstimatedCone cone;  // local
  bool certain = false;
};

using EpochCones = std::map<int64_t, LocalMapCone>;  // by id

void Remember(const local_map_t& local_map, EpochCones& cones) {
  for (const local_cone_t& cone : local_map.cones) {
    LocalMapCone& kept = cones[cone.id];
    kept.cone = {{cone.x_m, cone.y_m}, ColourOf(cone)};
    const auto existence = static_cast<double>(cone.existence);
    kept.certain = kept.certain || (existence >= kCertainExistence &&
                                    cone.num_observations >= kCertainObservations);
  }
}

struct Epoch {
  std::optional<Pose2> T_map_local;  // by the true pose at its first local map
  EpochCones cones;
};

std::map<int64_t, Epoch> CollectEpochs(const RunLog& log) {
  const TrueTrajectory trajectory(log);
  std::map<int64_t, Epoch> epochs;
  for (const local_map_t& local_map : log.local_maps) {
    Epoch& epoch = epochs[local_map.epoch];
    const Pose2 T_local_base{local_map.x_m, local_map.y_m, local_map.yaw_rad};
    if (!epoch.T_map_local)
      epoch.T_map_local = MomentaryMapFromLocal(trajectory, local_map.utime, T_local_base);
    Remember(local_map, epoch.cones);
  }
  std::erase_if(epochs, [](const auto& entry) { return !entry.second.T_map_local; });
  return epochs;
}

Points PositionsOf(const std::vector<EstimatedCone>& cones) {
  Points points;
  for (const EstimatedCone& cone : cones) points.push_back(cone.position);
  return points;
}

/// Returns T_truth_map.
Pose2 Add(const std::vector<EstimatedCone>& cones, const Points& truth, const Pose2& guess,
          MapComparison& comparison) {
  const Pose2 T_truth_map = AlignByIcp(PositionsOf(cones), truth, guess);
  for (const EstimatedCone& cone : cones) {
    const Eigen::Vector2d position = T_truth_map * cone.position;
    const Neighbour nearest = Nearest(truth, position);
    ComparedCone compared{position, cone.colour, std::nullopt, nearest.distance};
    if (nearest.distance <= kMatchGate) compared.match = nearest.index;
    comparison.cones.push_back(compared);
  }
  return T_truth_map;
}

void Count(size_t num_true, MapComparison& comparison) {
  std::vector<int> times_matched(num_true, 0);
  std::vector<double> distances;
  for (const ComparedCone& cone : comparison.cones) {
    if (!cone.match) {
      ++comparison.false_cones;
      continue;
    }
    distances.push_back(cone.distance);
    ++times_matched[*cone.match];
  }
  for (const int times : times_matched) {
    comparison.matched += times > 0 ? 1 : 0;
    comparison.missed += times == 0 ? 1 : 0;
    comparison.doubled += std::max(times - 1, 0);
  }
  comparison.rmse = RootMeanSquare(distances);
  comparison.worst = Percentile(distances, 100.0);
}

}  // namespace

ConeColour ColourOf(const local_cone_t& cone) { return MostProbableOf(cone.probability); }

ConeColour ColourOf(const global_cone_t& cone) { return MostProbableOf(cone.probability); }

std::optional<Pose2> AlignRigidly(const Points& from, const Points& to) {
  if (from.size() != to.size())
    throw std::invalid_argument("AlignRigidly: each point needs its partner");
  if (from.size() < 2) return std::nullopt;
  Eigen::Vector2d from_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_mean = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < from.size(); ++i) {
    from_mean += from[i];
    to_mean += to[i];
  }
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());
  double cosine = 0.0;  // both scaled by the same factor
  double sine = 0.0;
  for (size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d a = from[i] - from_mean;
    const Eigen::Vector2d b = to[i] - to_mean;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
  }
  if (std::hypot(cosine, sine) == 0.0) return std::nullopt;
  const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
  const Eigen::Vector2d shift = to_mean - turn * from_mean;
  return Pose2{shift.x(), shift.y(), turn.yaw};
}

Pose2 AlignByIcp(const Points& from, const Points& to, const Pose2& guess) {
  Pose2 T_to_from = guess;
  double gate = kFirstIcpGate;
  for (int i = 0; i < kMaxIcpIterations; ++i) {
    Points sources;
    Points targets;
    for (const Eigen::Vector2d& point : from) {
      const Neighbour nearest = Nearest(to, T_to_from * point);
      if (nearest.distance > gate) continue;
      sources.push_back(point);
      targets.push_back(to[nearest.index]);
    }
    const auto aligned = AlignRigidly(sources, targets);
    if (!aligned) return T_to_from;
    const bool done = gate == kMatchGate && IsSame(*aligned, T_to_from);
    T_to_from = *aligned;
    if (done) break;
    gate = std::max(kMatchGate, kIcpGateShrink * gate);
  }
  return T_to_from;
}

MapComparison CompareCones(const std::vector<EstimatedCone>& cones, const Points& truth,
                           const Pose2& guess) {
  MapComparison comparison;
  Add(cones, truth, guess, comparison);
  Count(truth.size(), comparison);
  return comparison;
}

std::optional<MapComparison> CompareLocalMaps(const RunLog& log) {
  if (!log.truth_track) return std::nullopt;
  const Points truth = TruePositions(log);
  const auto epochs = CollectEpochs(log);
  if (epochs.empty()) return std::nullopt;
  MapComparison comparison;
  for (const auto& [id, epoch] : epochs) {
    std::vector<EstimatedCone> certain;
    for (const auto& [cone_id, cone] : epoch.cones) {
      if (cone.certain) certain.push_back(cone.cone);
    }
    comparison.T_map_local[id] = Add(certain, truth, *epoch.T_map_local, comparison);
  }
  Count(truth.size(), comparison);
  return comparison;
}

std::optional<MapComparison> CompareGlobalMap(const RunLog& log) {
  if (!log.truth_track || log.global_maps.empty()) return std::nullopt;
  const TrueTrajectory trajectory(log);
  std::optional<Pose2> T_truth_map;  // by the true pose at the first map
  for (const global_map_t& map : log.global_maps) {
    const auto guess =
        MomentaryMapFromLocal(trajectory, map.utime, {map.x_m, map.y_m, map.yaw_rad});
    if (guess && !T_truth_map) T_truth_map = guess;
  }
  if (!T_truth_map) return std::nullopt;
  std::vector<EstimatedCone> cones;
  for (const global_cone_t& cone : log.global_maps.back().cones)
    cones.push_back({{cone.x_m, cone.y_m}, ColourOf(cone)});
  return CompareCones(cones, TruePositions(log), *T_truth_map);
}

std::optional<MapComparison> CompareMap(const RunLog& log) {
  const auto global = CompareGlobalMap(log);
  return global ? global : CompareLocalMaps(log);
}

nlohmann::json ToJson(const std::optional<MapComparison>& comparison) {
  if (!comparison) {
    return {{"rmse_m", nullptr}, {"worst_m", nullptr}, {"matched", nullptr},
            {"missed", nullptr}, {"false", nullptr},   {"doubled", nullptr}};
  }
  return {{"rmse_m", OrNull(comparison->rmse)}, {"worst_m", OrNull(comparison->worst)},
          {"matched", comparison->matched},     {"missed", comparison->missed},
          {"false", comparison->false_cones},   {"doubled", comparison->doubled}};
}

}  // namespace hairpin
