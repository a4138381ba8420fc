#include "daemons/path_tracker/polyline.hpp"

#include <algorithm>

namespace hairpin {

double PolylineLength(const std::vector<Eigen::Vector2d>& points) {
  double length = 0.0;
  for (size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

std::vector<Eigen::Vector2d> Resample(const std::vector<Eigen::Vector2d>& points, double length,
                                      size_t count) {
  std::vector<Eigen::Vector2d> samples;
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

}  // namespace hairpin
