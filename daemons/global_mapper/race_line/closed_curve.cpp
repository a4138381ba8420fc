#include "daemons/global_mapper/race_line/closed_curve.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

constexpr double kFewestSpacings = 10.0;

double PolylineLength(const Points& points) {
  double length = 0.0;
  for (size_t i = 0; i < points.size(); ++i)
    length += (points[(i + 1) % points.size()] - points[i]).norm();
  return length;
}

// Points of a closed polyline with a cubic Hermite curve between neighbours; its tangents have the
// direction of the chord over both neighbours, so that points close together do no harm.
class HermiteCurve {
 public:
  explicit HermiteCurve(const Points& points) : points_(points) {
    const size_t n = points.size();
    for (size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d& before = points[(i + n - 1) % n];
      const Eigen::Vector2d& after = points[(i + 1) % n];
      const double way = (points[i] - before).norm() + (after - points[i]).norm();
      tangents_.emplace_back(way > 0.0 ? Eigen::Vector2d((after - before) / way)
                                       : Eigen::Vector2d::Zero());
    }
  }

  Eigen::Vector2d At(size_t segment, double t) const {
    const size_t next = (segment + 1) % points_.size();
    const double size = (points_[next] - points_[segment]).norm();
    const double u = t * t * (3.0 - 2.0 * t);
    return (1.0 - u) * points_[segment] + u * points_[next] +
           size * t * (1.0 - t) * ((1.0 - t) * tangents_[segment] - t * tangents_[next]);
  }

 private:
  const Points& points_;
  Points tangents_;
};

// `count` points evenly spaced along the closed polyline, the first one at its first.
Points Resampled(const Points& points, double length, size_t count) {
  const HermiteCurve curve(points);
  Points samples;
  samples.reserve(count);
  size_t segment = 0;
  double before = 0.0;  // length of the polyline up to the segment
  double size = (points[1] - points[0]).norm();
  for (size_t i = 0; i < count; ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(count);
    while (before + size < s && segment + 1 < points.size()) {
      before += size;
      ++segment;
      size = (points[(segment + 1) % points.size()] - points[segment]).norm();
    }
    samples.push_back(curve.At(segment, size > 0.0 ? std::min((s - before) / size, 1.0) : 0.0));
  }
  return samples;
}

}  // namespace

ClosedCurve::ClosedCurve(const Points& points, double spacing) {
  if (points.size() < 3) throw std::invalid_argument("ClosedCurve: needs three points");
  if (!(spacing > 0.0)) throw std::invalid_argument("ClosedCurve: spacing must be > 0");
  const double length = PolylineLength(points);
  if (!(length >= kFewestSpacings * spacing)) {
    throw std::invalid_argument("ClosedCurve: is shorter than ten times the spacing");
  }
  const auto count = static_cast<size_t>(std::lround(length / spacing));
  points_ = Resampled(points, length, count);
  spacing_ = PolylineLength(points_) / static_cast<double>(count);
  normals_.resize(count);
  curvature_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d before = points_[i] - points_[(i + count - 1) % count];
    const Eigen::Vector2d after = points_[(i + 1) % count] - points_[i];
    const double cross = before.x() * after.y() - before.y() * after.x();
    curvature_[i] = std::atan2(cross, before.dot(after)) / spacing_;
    const Eigen::Vector2d along = (before.normalized() + after.normalized()).normalized();
    normals_[i] = Eigen::Vector2d(-along.y(), along.x());
  }
}

double ClosedCurve::SquaredCurvature() const {
  double sum = 0.0;
  for (const double k : curvature_) sum += k * k * spacing_;
  return sum;
}

ClosedCurve::Place ClosedCurve::Nearest(const Eigen::Vector2d& point) const {
  Place nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < size(); ++i) {
    const Eigen::Vector2d step = points_[(i + 1) % size()] - points_[i];
    const Eigen::Vector2d off = point - points_[i];
    const double t = std::clamp(off.dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double distance = (off - t * step).norm();
    if (distance >= nearest.distance) continue;
    const double side = step.x() * off.y() - step.y() * off.x();
    nearest = {std::fmod((static_cast<double>(i) + t) * spacing_, length()),
               std::copysign(distance, side), distance};
  }
  return nearest;
}

Eigen::Vector2d ClosedCurve::At(double s, double lateral) const {
  double wrapped = std::fmod(s, length());
  if (wrapped < 0.0) wrapped += length();
  const double position = wrapped / spacing_;
  const size_t i = static_cast<size_t>(position) % size();
  const size_t j = (i + 1) % size();
  const double t = position - std::floor(position);
  return (1.0 - t) * (points_[i] + lateral * normals_[i]) +
         t * (points_[j] + lateral * normals_[j]);
}

Points Smoothed(const ClosedCurve& curve, double smoothing_length) {
  constexpr std::array<double, 4> kDifference{-1.0, 3.0, -3.0, 1.0};
  const auto n = static_cast<Eigen::Index>(curve.size());
  const double lambda = std::pow(smoothing_length / curve.spacing(), 6.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < n; ++row) {
    entries.emplace_back(row, row, 1.0);
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j < 4; ++j) {
        entries.emplace_back(
            (row + i) % n, (row + j) % n,
            lambda * kDifference[static_cast<size_t>(i)] * kDifference[static_cast<size_t>(j)]);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixX2d right_side(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
    right_side.row(i) = curve.points()[static_cast<size_t>(i)].transpose();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::MatrixX2d solution = solver.solve(right_side);
  Points points(curve.size());
  for (Eigen::Index i = 0; i < n; ++i) points[static_cast<size_t>(i)] = solution.row(i).transpose();
  return points;
}

}  // namespace hairpin
