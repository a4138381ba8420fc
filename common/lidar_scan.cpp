#include "common/lidar_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/crc32c.hpp"

namespace hairpin {
namespace {

constexpr size_t kPointSize = 10;
constexpr size_t kMaxPoints = 1'000'000;  // several times what any sensor here returns

// Rounds to the nearest, halves away from zero, to an integer that fits into T: conversion cuts the
// fraction off. The comparison is false for NaN.
template <class T>
T Steps(float value, float steps_per_unit, const char* what) {
  const float steps = value * steps_per_unit;
  const float beyond = steps + std::copysign(0.5f, steps);
  const bool fits = beyond > static_cast<float>(std::numeric_limits<T>::min()) - 1.0f &&
                    beyond < static_cast<float>(std::numeric_limits<T>::max()) + 1.0f;
  if (!fits) throw std::invalid_argument(std::string("PackPoints: ") + what + " out of range");
  return static_cast<T>(static_cast<int32_t>(beyond));
}

void Write(uint8_t* bytes, uint16_t value) {
  bytes[0] = static_cast<uint8_t>(value);
  bytes[1] = static_cast<uint8_t>(value >> 8);
}

uint16_t Read(const uint8_t* bytes) { return static_cast<uint16_t>(bytes[0] | bytes[1] << 8); }

float Coordinate(const uint8_t* bytes, float step) {
  return static_cast<float>(static_cast<int16_t>(Read(bytes))) * step;
}

std::string_view Problem(const lidar_scan_t& scan) {
  if (!(scan.coordinate_step_m > 0.0 && scan.coordinate_step_m < 1.0))
    return "coordinate_step_m cannot be";
  if (!(scan.time_step_s > 0.0 && scan.time_step_s < 1.0)) return "time_step_s cannot be";
  if (!(scan.covered_share >= 0.0 && scan.covered_share <= 1.0)) return "covered_share cannot be";
  const auto& elevations = scan.ring_elevation_rad;
  if (elevations.empty() || elevations.size() > 256) return "no table of 1 to 256 rings";
  if (!std::is_sorted(elevations.begin(), elevations.end())) return "elevations do not rise";
  const size_t size = scan.points.size();
  if (size > kMaxPoints * kPointSize) return "too many points";
  if (scan.num_points < 0 || size != static_cast<size_t>(scan.num_points) * kPointSize)
    return "number of points and of bytes contradict each other";
  if (scan.points_crc32c != static_cast<int64_t>(Crc32c(scan.points.data(), size)))
    return "checksum of the points is wrong";
  return {};
}

}  // namespace

void PackPoints(std::span<const LidarPoint> points, lidar_scan_t& scan) {
  if (!(scan.coordinate_step_m > 0.0) || !(scan.time_step_s > 0.0))
    throw std::invalid_argument("PackPoints: steps must be > 0");
  if (points.size() > kMaxPoints) throw std::invalid_argument("PackPoints: too many points");
  const auto per_metre = static_cast<float>(1.0 / scan.coordinate_step_m);
  const auto per_second = static_cast<float>(1.0 / scan.time_step_s);
  scan.points.resize(points.size() * kPointSize);
  uint8_t* bytes = scan.points.data();
  for (const LidarPoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto steps = Steps<int16_t>(point.position[axis], per_metre, "coordinate");
      Write(bytes + ptrdiff_t{2} * axis, static_cast<uint16_t>(steps));
    }
    bytes[6] = point.intensity;
    bytes[7] = point.ring;
    Write(bytes + 8, Steps<uint16_t>(point.age, per_second, "age"));
    bytes += kPointSize;
  }
  scan.num_points = static_cast<int32_t>(points.size());
  scan.num_bytes = static_cast<int32_t>(scan.points.size());
  scan.points_crc32c = Crc32c(scan.points.data(), scan.points.size());
}

std::string_view UnpackPoints(const lidar_scan_t& scan, std::vector<LidarPoint>& points) {
  points.clear();
  if (const std::string_view problem = Problem(scan); !problem.empty()) return problem;
  const auto step = static_cast<float>(scan.coordinate_step_m);
  const auto time_step = static_cast<float>(scan.time_step_s);
  points.resize(static_cast<size_t>(scan.num_points));
  uint8_t highest_ring = 0;
  const uint8_t* bytes = scan.points.data();
  for (LidarPoint& point : points) {
    point.position = {Coordinate(bytes, step), Coordinate(bytes + 2, step),
                      Coordinate(bytes + 4, step)};
    point.intensity = bytes[6];
    point.ring = bytes[7];
    point.age = static_cast<float>(Read(bytes + 8)) * time_step;
    highest_ring = std::max(highest_ring, point.ring);
    bytes += kPointSize;
  }
  if (points.empty() || highest_ring < scan.ring_elevation_rad.size()) return {};
  points.clear();
  return "a ring that is not in the table";
}

}  // namespace hairpin
