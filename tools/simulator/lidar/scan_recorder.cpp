#include "tools/simulator/lidar/scan_recorder.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace hairpin {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kCut = std::numbers::pi;

}  // namespace

ScanRecorder::ScanRecorder(const LidarSensorParams& params, int64_t epoch_us)
    : params_(params), epoch_us_(epoch_us) {
  const auto& lasers = params.model.lasers;
  std::vector<size_t> order(lasers.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return lasers[a].elevation < lasers[b].elevation; });
  ring_.resize(lasers.size());
  for (size_t ring = 0; ring < order.size(); ++ring) {
    ring_[order[ring]] = static_cast<uint8_t>(ring);
    elevation_.push_back(static_cast<float>(lasers[order[ring]].elevation));
  }
}

std::optional<lidar_scan_t> ScanRecorder::Add(const FiringSequence& sequence) {
  std::optional<lidar_scan_t> finished;
  if (last_azimuth_ < kCut && sequence.azimuth_rad >= kCut && !points_.empty()) {
    finished = Finish();
    points_.clear();
  }
  last_azimuth_ = sequence.azimuth_rad;
  for (size_t channel = 0; channel < sequence.returns.size(); ++channel) {
    const LidarReturn& echo = sequence.returns[channel];
    if (echo.range <= 0.0f) continue;
    const Laser& laser = params_.model.lasers[channel];
    const double turned = kTurn * params_.rotation_hz * 1e-9 * static_cast<double>(laser.firing_ns);
    const Eigen::Vector3d direction =
        BeamDirection(laser.elevation, sequence.azimuth_rad + turned + laser.azimuth_offset);
    points_.push_back({{(echo.range * direction).cast<float>(), ReflectivityByte(echo.reflectivity),
                        ring_[channel], 0.0f},
                       sequence.start_ns + laser.firing_ns});
  }
  return finished;
}

lidar_scan_t ScanRecorder::Finish() const {
  const int64_t newest = std::max_element(points_.begin(), points_.end(), [](auto& a, auto& b) {
                           return a.time_ns < b.time_ns;
                         })->time_ns;
  std::vector<LidarPoint> points;
  for (const Point& entry : points_) {
    points.push_back(entry.point);
    points.back().age = static_cast<float>(static_cast<double>(newest - entry.time_ns) * 1e-9);
  }
  lidar_scan_t scan{};
  scan.utime = epoch_us_ + newest / 1000;
  scan.sensor_model = params_.model.name;
  scan.time_source = lidar_scan_t::TIME_GNSS;
  scan.covered_share = 1.0;
  scan.ring_elevation_rad = elevation_;
  scan.num_rings = static_cast<int32_t>(elevation_.size());
  scan.azimuth_step_rad =
      kTurn * params_.rotation_hz * 1e-9 * static_cast<double>(params_.model.sequence_ns);
  scan.coordinate_step_m = 0.004;
  scan.time_step_s = 2e-6;
  PackPoints(points, scan);
  return scan;
}

}  // namespace hairpin
