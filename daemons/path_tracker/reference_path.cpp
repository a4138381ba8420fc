#include "daemons/path_tracker/reference_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/geometry.hpp"

namespace hairpin {
namespace {

using Points = std::vector<Eigen::Vector2d>;

void Check(const ReferencePathParams& params) {
  if (!(params.spacing > 0.0)) throw std::invalid_argument("ReferencePath: spacing_m must be > 0");
  if (!(params.smoothing_length >= 0.0)) {
    throw std::invalid_argument("ReferencePath: smoothing_length_m must be >= 0");
  }
  if (!(params.max_length > params.spacing)) {
    throw std::invalid_argument("ReferencePath: max_length_m must be > spacing_m");
  }
}

double PolylineLength(const Points& points) {
  double length = 0.0;
  for (size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

// `count` points evenly spaced over the first `length` metres of the polyline.
Points Resample(const Points& points, double length, size_t count) {
  Points samples;
  samples.reserve(count);
  size_t segment = 1;
  double before = 0.0;  // length of the polyline up to the segment
  for (size_t i = 0; i < count; ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(count - 1);
    double step = (points[segment] - points[segment - 1]).norm();
    while (before + step < s && segment + 1 < points.size()) {
      before += step;
      ++segment;
      step = (points[segment] - points[segment - 1]).norm();
    }
    const double t = step > 0.0 ? std::min((s - before) / step, 1.0) : 1.0;
    samples.push_back(points[segment - 1] + t * (points[segment] - points[segment - 1]));
  }
  return samples;
}

// Solves (I + lambda D^T D) q = p with D the third difference: seven bands, by L D L^T without
// pivots (positive definite).
Points Smooth(const Points& p, double lambda) {
  constexpr size_t kOrder = 3;
  constexpr std::array<double, kOrder + 1> kDifference{-1.0, 3.0, -3.0, 1.0};
  const size_t n = p.size();
  std::vector<std::array<double, kOrder + 1>> band(n, {1.0});  // diagonal and those below it
  for (size_t row = 0; row + kOrder < n; ++row) {
    for (size_t i = 0; i <= kOrder; ++i) {
      for (size_t j = 0; j <= i; ++j)
        band[row + j][i - j] += lambda * kDifference[i] * kDifference[j];
    }
  }
  Points q = p;
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 1; k <= kOrder && i + k < n; ++k) {
      const double factor = band[i][k] / band[i][0];
      for (size_t j = k; j <= kOrder && i + j < n; ++j) band[i + k][j - k] -= factor * band[i][j];
      q[i + k] -= factor * q[i];
    }
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = 1; k <= kOrder && i + k < n; ++k) q[i] -= band[i][k] * q[i + k];
    q[i] /= band[i][0];
  }
  return q;
}

}  // namespace

ReferencePath::ReferencePath(const Points& points, const ReferencePathParams& params) {
  Check(params);
  const double length = std::min(PolylineLength(points), params.max_length);
  if (!(length > 0.01 * params.spacing)) {
    throw std::invalid_argument("ReferencePath: the path has no length");
  }
  const size_t count =
      std::max<size_t>(3, static_cast<size_t>(std::lround(length / params.spacing)) + 1);
  const double step = length / static_cast<double>(count - 1);
  const Points smooth =
      Smooth(Resample(points, length, count), std::pow(params.smoothing_length / step, 6.0));
  // Smoothing has cut corners: even out the spacing once more, so that index and arc length agree.
  const double smooth_length = PolylineLength(smooth);
  spacing_ = smooth_length / static_cast<double>(count - 1);
  points_ = Resample(smooth, smooth_length, count);

  std::vector<double> chord(count - 1);  // headings of the segments, continuous
  for (size_t i = 0; i + 1 < count; ++i) {
    const Eigen::Vector2d d = points_[i + 1] - points_[i];
    const double angle = std::atan2(d.y(), d.x());
    chord[i] = i == 0 ? angle : chord[i - 1] + WrapAngle(angle - chord[i - 1]);
  }
  heading_.assign(count, chord.front());
  curvature_.assign(count, 0.0);
  for (size_t i = 1; i + 1 < count; ++i) {
    heading_[i] = 0.5 * (chord[i - 1] + chord[i]);
    curvature_[i] = (chord[i] - chord[i - 1]) / spacing_;
  }
  heading_.back() = chord.back();
  curvature_.front() = curvature_[1];
  curvature_.back() = curvature_[count - 2];
}

Eigen::Vector2d ReferencePath::PointAt(double s) const {
  const double position = std::clamp(s / spacing_, 0.0, static_cast<double>(points_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), points_.size() - 2);
  return points_[i] + (position - static_cast<double>(i)) * (points_[i + 1] - points_[i]);
}

ReferencePath::Location ReferencePath::At(const Eigen::Vector2d& point, size_t segment,
                                          double along) const {
  const Eigen::Vector2d start = points_[segment];
  const Eigen::Vector2d direction = (points_[segment + 1] - start).normalized();
  const double t = std::clamp(along / spacing_, 0.0, 1.0);
  const Eigen::Vector2d offset = point - (start + along * direction);
  Location location;
  location.s = static_cast<double>(segment) * spacing_ + along;
  location.lateral_error = direction.x() * offset.y() - direction.y() * offset.x();
  location.heading = (1.0 - t) * heading_[segment] + t * heading_[segment + 1];
  location.curvature = (1.0 - t) * curvature_[segment] + t * curvature_[segment + 1];
  if (along < 0.0 || along > spacing_) location.curvature = 0.0;  // past an end it is straight
  return location;
}

ReferencePath::Location ReferencePath::Locate(const Eigen::Vector2d& point, double s_min,
                                              double s_max) const {
  const size_t segments = points_.size() - 1;
  const auto clamped = [&](double s) {
    return static_cast<size_t>(std::clamp(s / spacing_, 0.0, static_cast<double>(segments - 1)));
  };
  const size_t first = clamped(s_min);
  const size_t last = clamped(std::max(s_min, s_max));
  double least = std::numeric_limits<double>::infinity();
  size_t nearest = first;
  double nearest_along = 0.0;
  for (size_t i = first; i <= last; ++i) {
    const Eigen::Vector2d direction = (points_[i + 1] - points_[i]).normalized();
    double along = (point - points_[i]).dot(direction);
    if (i > 0) along = std::max(along, 0.0);
    if (i + 1 < segments) along = std::min(along, spacing_);
    const double distance = (points_[i] + along * direction - point).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = i;
      nearest_along = along;
    }
  }
  return At(point, nearest, nearest_along);
}

}  // namespace hairpin
