#include "daemons/global_mapper/constellation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

constexpr double kMinBaseline = 3.0;  // m: a nearer pair says little of the turn
constexpr size_t kMaxPoints = 40;     // bounds the work; the first ones count

constexpr int kRefinements = 3;

using Points = std::vector<ConstellationPoint>;
using Points2d = std::vector<Eigen::Vector2d>;
using Pairs = std::vector<std::pair<size_t, size_t>>;

bool IsOrange(ConeColour colour) {
  return colour == ConeColour::kOrange || colour == ConeColour::kOrangeLarge;
}

Eigen::Vector2d Centre(const Points& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const ConstellationPoint& point : points) sum += point.position;
  return sum / static_cast<double>(points.size());
}

double WeightOf(const ConstellationPoint& a, const ConstellationPoint& b,
                const ConstellationParams& params) {
  return AreCompatible(a.colour, b.colour) ? 1.0 : params.contradiction_weight;
}

/// T that takes a pair to another one, midpoint to midpoint.
Pose2 MotionOfPair(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p,
                   const Eigen::Vector2d& q) {
  const Eigen::Vector2d from = b - a;
  const Eigen::Vector2d to = q - p;
  const Pose2 turn{0.0, 0.0, std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to))};
  const Eigen::Vector2d shift = 0.5 * (p + q) - turn * Eigen::Vector2d(0.5 * (a + b));
  return {shift.x(), shift.y(), turn.yaw};
}

/// Nearest partners within the tolerance, nearest first, each point once. The score is without any
/// penalty.
ConstellationMatch Pair(const Points& from, const Points& to, const Pose2& T_to_from,
                        const ConstellationParams& params) {
  struct Candidate {
    double distance;
    size_t from;
    size_t to;
  };
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d position = T_to_from * from[i].position;
    for (size_t j = 0; j < to.size(); ++j) {
      const double distance = (position - to[j].position).norm();
      if (distance < params.tolerance && WeightOf(from[i], to[j], params) > 0.0)
        candidates.push_back({distance, i, j});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.from, a.to) < std::tie(b.distance, b.from, b.to);
  });
  std::vector<bool> from_taken(from.size(), false);
  std::vector<bool> to_taken(to.size(), false);
  ConstellationMatch match{T_to_from, {}, 0.0, 0.0};
  double squares = 0.0;
  for (const Candidate& candidate : candidates) {
    if (from_taken[candidate.from] || to_taken[candidate.to]) continue;
    from_taken[candidate.from] = to_taken[candidate.to] = true;
    match.pairs.emplace_back(candidate.from, candidate.to);
    squares += candidate.distance * candidate.distance;
    match.score += WeightOf(from[candidate.from], to[candidate.to], params) *
                   (1.0 - std::pow(candidate.distance / params.tolerance, 2));
  }
  if (!match.pairs.empty())
    match.rmse = std::sqrt(squares / static_cast<double>(match.pairs.size()));
  return match;
}

/// Least squares over the pairs, in closed form [Arun 1987].
Pose2 Align(const Points& from, const Points& to, const ConstellationMatch& match) {
  Eigen::Vector2d from_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_mean = Eigen::Vector2d::Zero();
  for (const auto& [i, j] : match.pairs) {
    from_mean += from[i].position;
    to_mean += to[j].position;
  }
  from_mean /= static_cast<double>(match.pairs.size());
  to_mean /= static_cast<double>(match.pairs.size());
  double cosine = 0.0;
  double sine = 0.0;
  for (const auto& [i, j] : match.pairs) {
    const Eigen::Vector2d a = from[i].position - from_mean;
    const Eigen::Vector2d b = to[j].position - to_mean;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
  }
  const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
  const Eigen::Vector2d shift = to_mean - turn * from_mean;
  return {shift.x(), shift.y(), turn.yaw};
}

bool IsBetter(const ConstellationMatch& a, const ConstellationMatch& b) {
  return a.score != b.score ? a.score > b.score : a.rmse < b.rmse;
}

class Search {
 public:
  Search(const Points& from, const Points& to, const Pose2& guess,
         const ConstellationParams& params, const PlacePenalty& penalty)
      : from_(from),
        to_(to),
        guess_(guess),
        params_(params),
        penalty_(penalty),
        centre_(Centre(from)) {
    for (const ConstellationPoint& point : to) by_x_.push_back(point.position);
    std::sort(by_x_.begin(), by_x_.end(),
              [](const auto& a, const auto& b) { return a.x() < b.x(); });
  }

  std::optional<ConstellationMatch> Run() {
    for (size_t i = 0; i < from_.size(); ++i) {
      for (size_t j = i + 1; j < from_.size(); ++j) TryPair(from_[i], from_[j]);
    }
    if (best_.pairs.size() < params_.min_pairs) return std::nullopt;
    const bool ambiguous = std::any_of(places_.begin(), places_.end(), [this](const auto& place) {
      return place.second + static_cast<double>(params_.min_lead) > best_.score &&
             IsElsewhere(place.first);
    });
    if (ambiguous) return std::nullopt;
    return best_;
  }

 private:
  void TryPair(const ConstellationPoint& a, const ConstellationPoint& b) {
    const double baseline = (b.position - a.position).norm();
    if (baseline < kMinBaseline) return;
    for (const ConstellationPoint& p : to_) {
      const double weight = WeightOf(a, p, params_);
      if (weight <= 0.0) continue;
      for (const ConstellationPoint& q : to_) {
        // One of the two at least is a pair without contradiction.
        if (&p == &q || std::max(weight, WeightOf(b, q, params_)) < 1.0) continue;
        if (WeightOf(b, q, params_) <= 0.0) continue;
        if (std::abs((q.position - p.position).norm() - baseline) > params_.tolerance) continue;
        const Pose2 motion = MotionOfPair(a.position, b.position, p.position, q.position);
        if (IsWithinBounds(motion) && IsPromising(motion)) Consider(motion);
      }
    }
  }

  bool IsWithinBounds(const Pose2& motion) const {
    return std::abs(WrapAngle(motion.yaw - guess_.yaw)) <= params_.max_rotation &&
           (motion * centre_ - guess_ * centre_).norm() <= params_.max_translation;
  }

  /// True if half the points wanted, and one beyond the pair itself, come near any: most motions
  /// can be passed over for little.
  bool IsPromising(const Pose2& motion) const {
    const double tolerance = params_.tolerance;
    const size_t wanted = std::max<size_t>(3, (params_.min_pairs + 1) / 2);
    size_t near = 0;
    for (const ConstellationPoint& point : from_) {
      const Eigen::Vector2d position = motion * point.position;
      auto other = std::lower_bound(by_x_.begin(), by_x_.end(), position.x() - tolerance,
                                    [](const auto& a, double x) { return a.x() < x; });
      for (; other != by_x_.end() && other->x() < position.x() + tolerance; ++other) {
        if (std::abs(other->y() - position.y()) >= tolerance) continue;
        if (++near >= wanted) return true;
        break;
      }
    }
    return false;
  }

  void Consider(const Pose2& motion) {
    ConstellationMatch match = Pair(from_, to_, motion, params_);
    for (int i = 0; i < kRefinements && match.pairs.size() >= 2; ++i)
      match = Pair(from_, to_, Align(from_, to_, match), params_);
    if (!IsWithinBounds(match.T_to_from)) return;
    if (penalty_) match.score -= penalty_(match.T_to_from);
    Remember(match);
    if (IsBetter(match, best_)) best_ = std::move(match);
  }

  /// Keeps the best score of each set of pairs found.
  void Remember(const ConstellationMatch& match) {
    Pairs pairs = match.pairs;
    std::sort(pairs.begin(), pairs.end());
    const auto [place, is_new] = places_.try_emplace(std::move(pairs), match.score);
    if (!is_new) place->second = std::max(place->second, match.score);
  }

  /// True if most of the pairs are others than the best place's.
  bool IsElsewhere(const Pairs& pairs) const {
    const auto shared = std::count_if(pairs.begin(), pairs.end(), [this](const auto& pair) {
      return std::find(best_.pairs.begin(), best_.pairs.end(), pair) != best_.pairs.end();
    });
    return 2 * static_cast<size_t>(shared) < pairs.size();
  }

  const Points& from_;
  const Points& to_;
  Pose2 guess_;
  ConstellationParams params_;
  const PlacePenalty& penalty_;
  Eigen::Vector2d centre_;
  Points2d by_x_;  // positions of `to`, by rising x
  ConstellationMatch best_;
  std::map<Pairs, double> places_;  // score by sorted pairs
};

Points FirstOf(const Points& points) {
  return {points.begin(),
          points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), kMaxPoints))};
}

}  // namespace

void ConstellationParams::Validate() const {
  require(tolerance > 0.0, "constellation tolerance must be > 0");
  require(max_translation > 0.0, "constellation max_translation must be > 0");
  require(max_rotation > 0.0, "constellation max_rotation must be > 0");
  require(min_pairs >= 3, "constellation min_pairs must be >= 3");
  require(min_lead >= 1, "constellation min_lead must be >= 1");
  require(contradiction_weight >= 0.0 && contradiction_weight <= 1.0,
          "constellation contradiction_weight must be in [0, 1]");
}

bool AreCompatible(ConeColour a, ConeColour b) {
  if (a == ConeColour::kUnknown || b == ConeColour::kUnknown || a == b) return true;
  return IsOrange(a) && IsOrange(b);
}

std::optional<ConstellationMatch> MatchConstellation(const Points& from, const Points& to,
                                                     const Pose2& guess,
                                                     const ConstellationParams& params,
                                                     const PlacePenalty& penalty) {
  if (from.size() < params.min_pairs || to.size() < params.min_pairs) return std::nullopt;
  const Points some = FirstOf(from);
  const Points others = FirstOf(to);
  return Search(some, others, guess, params, penalty).Run();
}

}  // namespace hairpin
