#include "daemons/path_tracker/corridor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "daemons/path_tracker/polyline.hpp"

namespace hairpin {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr int kMaxIterations = 12;  // of the active set; it settles in three or four
constexpr size_t kMaxPoints = 120;  // 60 m at half a metre: bounds the work

void Check(const CorridorParams& params) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("Corridor: ") + what);
  };
  require(params.spacing > 0.0, "path_spacing_m must be > 0");
  require(params.margin > 0.0, "boundary_margin_m must be > 0");
  require(params.max_offset >= 0.0, "max_offset_m must be >= 0");
  require(params.centring_length > 0.0, "centring_length_m must be > 0");
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Distance to a side, negative beyond it. `inward` is +1 where the track lies left of the side, -1
// where right.
double DistanceTo(const Points& side, const Eigen::Vector2d& point, double inward) {
  double nearest = std::numeric_limits<double>::infinity();
  double sign = 1.0;
  if (side.size() == 1) return (point - side[0]).norm();
  for (size_t i = 0; i + 1 < side.size(); ++i) {
    const Eigen::Vector2d along = side[i + 1] - side[i];
    const double length2 = std::max(along.squaredNorm(), 1e-9);
    const double t = (point - side[i]).dot(along) / length2;
    const double distance = (point - side[i] - std::clamp(t, 0.0, 1.0) * along).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    const bool beside = t > 0.0 && t < 1.0;  // past its ends a side bounds nothing
    sign = beside && inward * Cross(along, point - side[i]) < 0.0 ? -1.0 : 1.0;
  }
  return sign * nearest;
}

struct Bounds {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

Bounds OffsetBounds(const Points& middle, const Corridor& corridor, const CorridorParams& params) {
  const auto n = static_cast<Eigen::Index>(middle.size());
  Bounds bounds{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index i = 1; i < n; ++i) {
    const Eigen::Vector2d& point = middle[static_cast<size_t>(i)];
    double upper =
        corridor.left.empty() ? 0.0 : DistanceTo(corridor.left, point, -1.0) - params.margin;
    double lower =
        corridor.right.empty() ? 0.0 : params.margin - DistanceTo(corridor.right, point, 1.0);
    if (upper < lower) upper = lower = 0.5 * (upper + lower);  // too narrow: the middle
    bounds.upper[i] = std::clamp(upper, -params.max_offset, params.max_offset);
    bounds.lower[i] = std::clamp(lower, -params.max_offset, params.max_offset);
  }
  return bounds;
}

Points Normals(const Points& middle) {
  Points normals(middle.size());
  for (size_t i = 0; i < middle.size(); ++i) {
    const Eigen::Vector2d& before = middle[i == 0 ? 0 : i - 1];
    const Eigen::Vector2d& after = middle[std::min(i + 1, middle.size() - 1)];
    const Eigen::Vector2d tangent = (after - before).normalized();
    normals[i] = {-tangent.y(), tangent.x()};
  }
  return normals;
}

// Offsets d with 1/2 d^T H d + g^T d least and lower <= d <= upper.
Eigen::VectorXd SolveBoxed(const Eigen::MatrixXd& H, const Eigen::VectorXd& g,
                           const Bounds& bounds) {
  const Eigen::Index n = g.size();
  Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
  Eigen::VectorXi active = Eigen::VectorXi::Zero(n);  // -1: at the lower bound, +1: at the upper
  active[0] = 1;                                      // the car is where it is
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::MatrixXd reduced = H;
    Eigen::VectorXd right = -g;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (active[i] != 0) right -= H.col(i) * (active[i] > 0 ? bounds.upper[i] : bounds.lower[i]);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (active[i] == 0) continue;
      reduced.row(i).setZero();
      reduced.col(i).setZero();
      reduced(i, i) = 1.0;
      right[i] = active[i] > 0 ? bounds.upper[i] : bounds.lower[i];
    }
    d = reduced.llt().solve(right);
    const Eigen::VectorXd multiplier = -(H * d + g);  // pushes outward where a bound holds
    Eigen::VectorXi next = Eigen::VectorXi::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (multiplier[i] + H(i, i) * (d[i] - bounds.upper[i]) > 0.0) next[i] = 1;
      if (multiplier[i] + H(i, i) * (d[i] - bounds.lower[i]) < 0.0) next[i] = -1;
    }
    next[0] = 1;
    if (next == active) break;
    active = next;
  }
  return d.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
}

}  // namespace

Points LeastBending(const Corridor& corridor, double start_yaw, const CorridorParams& params) {
  Check(params);
  const double length = corridor.middle.size() < 2 ? 0.0 : PolylineLength(corridor.middle);
  const auto steps = static_cast<size_t>(std::lround(length / params.spacing));
  if (steps < 2 || steps >= kMaxPoints) return corridor.middle;
  const Points middle = Resample(corridor.middle, length, steps + 1);
  const Points normals = Normals(middle);
  const double h = length / static_cast<double>(steps);

  const auto n = static_cast<Eigen::Index>(middle.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(n, n) * std::pow(h / params.centring_length, 4.0);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
  const Eigen::Vector2d behind =
      middle[0] - h * Eigen::Vector2d(std::cos(start_yaw), std::sin(start_yaw));
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    // The second difference at i is constant + sum of coefficient * normal * offset over its three
    // points.
    const auto at = [&](Eigen::Index j) { return j < 0 ? behind : middle[static_cast<size_t>(j)]; };
    const Eigen::Vector2d constant = at(i - 1) - 2.0 * at(i) + at(i + 1);
    for (Eigen::Index j = std::max<Eigen::Index>(i - 1, 0); j <= i + 1; ++j) {
      const Eigen::Vector2d a = (j == i ? -2.0 : 1.0) * normals[static_cast<size_t>(j)];
      g[j] += a.dot(constant);
      for (Eigen::Index k = std::max<Eigen::Index>(i - 1, 0); k <= i + 1; ++k) {
        H(j, k) += a.dot((k == i ? -2.0 : 1.0) * normals[static_cast<size_t>(k)]);
      }
    }
  }
  const Eigen::VectorXd offsets = SolveBoxed(H, g, OffsetBounds(middle, corridor, params));
  Points path = middle;
  for (size_t i = 0; i < path.size(); ++i)
    path[i] += offsets[static_cast<Eigen::Index>(i)] * normals[i];
  return path;
}

}  // namespace hairpin
