#include "daemons/boundary_estimator/one_sided.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

size_t Index(int i) { return static_cast<size_t>(i); }

double RatioOf(const SideLogRatios& ratios, Side side) {
  return side == Side::kLeft ? ratios.left : ratios.right;
}

Side OtherThan(Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; }

int ConeOf(const CrossedEdge& edge, Side side) {
  return side == Side::kLeft ? edge.left : edge.right;
}

// True if a cone that is surely of the other side stands close to `position` on the outside of the
// side, which leads along `along`: then `position` bounds another stretch of track.
bool BoundsAnotherStretch(const Scene& scene, Side side, const Eigen::Vector2d& position,
                          const Eigen::Vector2d& along, const OneSidedParams& params) {
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    if (RatioOf(scene.ratios[i], side) >= params.min_log_ratio) continue;
    const Eigen::Vector2d offset = scene.positions[i] - position;
    const double to_left = along.x() * offset.y() - along.y() * offset.x();
    const double outward = side == Side::kLeft ? to_left : -to_left;
    if (outward > params.min_spacing && offset.norm() < params.max_spacing) return true;
  }
  return false;
}

// The cone next to `from` that may belong to the side, within the turn allowed of `direction`. A
// cone that lies askew counts as farther: another stretch of track may be as near as this side's
// own next cone.
std::optional<int> NextCone(const Scene& scene, Side side, const Eigen::Vector2d& from,
                            const Eigen::Vector2d& direction, const std::vector<bool>& taken,
                            const OneSidedParams& params) {
  const double least_cosine = std::cos(params.max_turn);
  std::optional<int> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    if (taken[i] || RatioOf(scene.ratios[i], side) < params.min_log_ratio) continue;
    const Eigen::Vector2d step = scene.positions[i] - from;
    const double distance = step.norm();
    const double cosine = step.dot(direction) / distance;
    if (distance < params.min_spacing || distance > params.max_spacing || cosine < least_cosine)
      continue;
    if (distance / cosine >= least) continue;
    if (BoundsAnotherStretch(scene, side, scene.positions[i], step / distance, params)) continue;
    nearest = static_cast<int>(i);
    least = distance / cosine;
  }
  return nearest;
}

// The cones that follow on `from`, which leaves in `direction`.
std::vector<int> Follow(const Scene& scene, Side side, int from, Eigen::Vector2d direction,
                        std::vector<bool> taken, const OneSidedParams& params) {
  std::vector<int> chain;
  taken[Index(from)] = true;
  while (const auto next =
             NextCone(scene, side, scene.positions[Index(from)], direction, taken, params)) {
    direction = (scene.positions[Index(*next)] - scene.positions[Index(from)]).normalized();
    from = *next;
    taken[Index(from)] = true;
    chain.push_back(from);
  }
  return chain;
}

// A gate at `cone`, `width` wide, across the direction `along` of the side.
Gate InferGate(const Eigen::Vector2d& cone, const Eigen::Vector2d& along, Side side, double width) {
  const Eigen::Vector2d to_left = width * Eigen::Vector2d(-along.y(), along.x());
  return side == Side::kLeft ? Gate{cone, cone - to_left} : Gate{cone + to_left, cone};
}

// Appends gates at the cones of `chain`, but not where a gate would lie behind the end of the
// stretch, as on the inside of a tight bend. `arriving`: direction of the side at the first cone.
void AppendChain(const Scene& scene, Side side, const std::vector<int>& chain,
                 Eigen::Vector2d arriving, double width, const OneSidedParams& params,
                 Stretch& stretch) {
  for (size_t i = 0; i < chain.size(); ++i) {
    const Eigen::Vector2d& cone = scene.positions[Index(chain[i])];
    Eigen::Vector2d leaving = arriving;
    if (i + 1 < chain.size()) leaving = (scene.positions[Index(chain[i + 1])] - cone).normalized();
    const Gate gate = InferGate(cone, (arriving + leaving).normalized(), side, width);
    arriving = leaving;
    const Eigen::Vector2d step = gate.middle() - stretch.end();
    if (step.dot(stretch.end_direction()) < 0.5 * params.min_spacing) continue;
    const bool left = side == Side::kLeft;
    stretch.Append(
        {left ? chain[i] : CrossedEdge::kInferred, left ? CrossedEdge::kInferred : chain[i]}, gate);
  }
}

// The nearest cone ahead of the car that is of the side by its colour or, that being unknown, by
// its place.
std::optional<int> FirstCone(const Scene& scene, Side side, const OneSidedParams& params) {
  std::optional<int> nearest;
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    const Eigen::Vector2d& position = scene.positions[i];
    const bool on_its_side = side == Side::kLeft ? position.y() > 0.0 : position.y() < 0.0;
    const bool sure = RatioOf(scene.ratios[i], OtherThan(side)) < params.min_log_ratio;
    if (position.x() < 0.0 || position.norm() > params.max_spacing || !(sure || on_its_side))
      continue;
    if (RatioOf(scene.ratios[i], side) < params.min_log_ratio) continue;
    if (!nearest || position.norm() < scene.positions[Index(*nearest)].norm())
      nearest = static_cast<int>(i);
  }
  return nearest;
}

std::vector<int> ConesOf(const Stretch& stretch, Side side) {
  std::vector<int> cones;
  for (const CrossedEdge& edge : stretch.edges) {
    const int cone = ConeOf(edge, side);
    if (cone != CrossedEdge::kInferred && (cones.empty() || cones.back() != cone))
      cones.push_back(cone);
  }
  return cones;
}

// Of a side at its last cone; the path's where the side has but one mark.
Eigen::Vector2d EndDirection(const Scene& scene, const std::vector<int>& cones,
                             const Stretch& stretch, const OneSidedParams& params) {
  if (cones.size() < 2) return stretch.end_direction();
  const Eigen::Vector2d step =
      scene.positions[Index(cones.back())] - scene.positions[Index(cones[cones.size() - 2])];
  return step.norm() < params.min_spacing ? stretch.end_direction()
                                          : Eigen::Vector2d(step.normalized());
}

// How far a side's cones lead past the end of the stretch: to its last cone, and along the chain.
double LeadOf(const Scene& scene, const std::vector<int>& chain, const Stretch& stretch) {
  const Eigen::Vector2d step = scene.positions[Index(chain.front())] - stretch.end();
  double length = step.dot(stretch.end_direction());
  for (size_t i = 1; i < chain.size(); ++i) {
    length += (scene.positions[Index(chain[i])] - scene.positions[Index(chain[i - 1])]).norm();
  }
  return length;
}

}  // namespace

void Check(const OneSidedParams& params) {
  constexpr Require require("OneSidedParams");
  require(params.min_spacing > 0.0, "min_spacing must be > 0");
  require(params.max_spacing > params.min_spacing, "max_spacing must be > min_spacing");
  require(params.max_turn > 0.0 && params.max_turn < 0.5 * std::numbers::pi,
          "max_turn must be in (0, pi/2)");
  require(params.min_log_ratio <= 0.0, "min_log_ratio must be <= 0");
  require(params.max_jump > 0.0, "max_jump must be > 0");
  require(params.log_penalty >= 0.0, "log_penalty must be >= 0");
  require(params.default_width > 0.0, "default_width must be > 0");
}

Stretch FollowSideFromCar(const Scene& scene, Side side, double width,
                          const OneSidedParams& params) {
  Stretch stretch;
  const std::optional<int> first = FirstCone(scene, side, params);
  if (!first) return stretch;
  std::vector<int> chain = Follow(scene, side, *first, Eigen::Vector2d::UnitX(),
                                  std::vector<bool>(scene.positions.size(), false), params);
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  if (!chain.empty())
    along = (scene.positions[Index(chain[0])] - scene.positions[Index(*first)]).normalized();
  chain.insert(chain.begin(), *first);
  AppendChain(scene, side, chain, along, width, params, stretch);
  return stretch;
}

void ContinueOnOneSide(const Scene& scene, double width, const OneSidedParams& params,
                       Stretch& stretch) {
  std::vector<bool> taken(scene.positions.size(), false);
  for (const CrossedEdge& edge : stretch.edges) {
    for (const int cone : {edge.left, edge.right}) {
      if (cone != CrossedEdge::kInferred) taken[Index(cone)] = true;
    }
  }
  Side best_side = Side::kLeft;
  std::vector<int> best;
  Eigen::Vector2d best_arriving = stretch.end_direction();
  double farthest = 0.0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const std::vector<int> cones = ConesOf(stretch, side);
    if (cones.empty()) continue;
    const Eigen::Vector2d arriving = EndDirection(scene, cones, stretch, params);
    std::vector<int> chain = Follow(scene, side, cones.back(), arriving, taken, params);
    chain.insert(chain.begin(), cones.back());
    const double lead = LeadOf(scene, chain, stretch);
    if (lead <= farthest) continue;
    farthest = lead;
    best_side = side;
    best = chain;
    best_arriving = arriving;
  }
  AppendChain(scene, best_side, best, best_arriving, width, params, stretch);
}

void FillJump(const Stretch& one_sided, const OneSidedParams& params, Stretch& stretch) {
  if (stretch.empty() || stretch.gates.front().middle().norm() <= params.max_jump) return;
  const CrossedEdge goal = stretch.edges.front();
  const auto joins = [&](const CrossedEdge& edge) {
    return edge.left == goal.left || edge.right == goal.right;
  };
  const auto join = std::find_if(one_sided.edges.begin(), one_sided.edges.end(), joins);
  if (join == one_sided.edges.end()) return;
  const auto count = join - one_sided.edges.begin();
  stretch.edges.insert(stretch.edges.begin(), one_sided.edges.begin(), join);
  stretch.gates.insert(stretch.gates.begin(), one_sided.gates.begin(),
                       one_sided.gates.begin() + count);
}

}  // namespace hairpin
