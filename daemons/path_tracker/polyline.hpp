#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hairpin {

double PolylineLength(const std::vector<Eigen::Vector2d>& points);

/// `count` (>= 2) points evenly spaced over the first `length` metres of the polyline of at least
/// two points.
std::vector<Eigen::Vector2d> Resample(const std::vector<Eigen::Vector2d>& points, double length,
                                      size_t count);

}  // namespace hairpin
