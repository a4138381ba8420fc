#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/channels.hpp"
#include "common/clock.hpp"
#include "daemons/lidar_cone_detector/conversion.hpp"
#include "daemons/lidar_cone_detector/deskew.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_config.hpp"
#include "daemons/lidar_cone_detector/view.hpp"

namespace hairpin {
namespace {

constexpr double kHistory = 1.0;    // s: a revolution, its wait, and what comes late
constexpr size_t kMaxSectors = 16;  // that local_mapper takes

}  // namespace

LidarConeDetectorNode::LidarConeDetectorNode(const LidarConeDetectorNodeParams& params, Bus& bus)
    : params_(params),
      bus_(bus),
      detector_(params.detector),
      colours_(params.colour),
      history_(kHistory),
      pairing_(params.pairing) {
  bus.Subscribe(channels::kVelocity, [this](const velocity_t& m) { OnVelocity(m); });
  SubscribeScans(channels::kLidarFront, 0);
  SubscribeScans(channels::kLidarTop, 1);
}

void LidarConeDetectorNode::SubscribeScans(const Channel<lidar_scan_t>& channel, size_t lidar) {
  bus_.Subscribe(channel, [this, channel, lidar](const lidar_scan_t& message) {
    LidarRevolution scan;
    const std::string_view problem = ToRevolution(message, scan);
    if (!problem.empty()) return bus_.Refuse(channel, std::string(problem));
    while (const std::optional<ScanSet> set = pairing_.MakeRoom(lidar)) Detect(*set);
    if (!pairing_.Add(lidar, std::move(scan))) return bus_.Refuse(channel, "time goes back");
    RunWhatIsReady();
  });
}

void LidarConeDetectorNode::OnVelocity(const velocity_t& velocity) {
  if (!velocity.valid) return;  // a gap, which the next valid one closes
  if (std::hypot(velocity.vx_mps, velocity.vy_mps) > params_.max_speed ||
      std::abs(velocity.yaw_rate_radps) > params_.max_yaw_rate)
    return bus_.Refuse(channels::kVelocity, "absurd velocity");
  if (!history_.Add(velocity.utime, {velocity.vx_mps, velocity.vy_mps, velocity.yaw_rate_radps}))
    return bus_.Refuse(channels::kVelocity, "time goes back");
  RunWhatIsReady();
}

void LidarConeDetectorNode::RunWhatIsReady() {
  const int64_t now = std::max(bus_.newest_utime(), history_.newest_utime());
  while (const std::optional<ScanSet> set = pairing_.Take(now)) Detect(*set);
}

void LidarConeDetectorNode::Detect(const ScanSet& scans) {
  double duration = 0.0;
  for (const auto& scan : scans.scans) {
    if (scan)
      duration = std::max(duration, scan->duration + SecondsBetween(scan->utime, scans.utime));
  }
  const std::optional<MotionTable> motion = MotionTable::Make(history_, scans.utime, duration);
  if (!motion) {
    const bool front = scans.scans[0].has_value();
    return bus_.Refuse(front ? channels::kLidarFront : channels::kLidarTop,
                       "no velocity for the time of the scan");
  }
  cloud_.Clear();
  geometry_.clear();
  for (size_t i = 0; i < scans.scans.size(); ++i) {
    if (!scans.scans[i]) continue;
    const LidarRevolution& scan = *scans.scans[i];
    const auto sensor = static_cast<uint8_t>(geometry_.size());
    geometry_.push_back({params_.T_base_sensor[i], scan.ring_elevation, scan.azimuth_step});
    Deskew(scan.points, params_.T_base_sensor[i],
           static_cast<float>(SecondsBetween(scan.utime, scans.utime)), *motion, params_.body,
           sensor, cloud_);
  }
  Publish(scans.utime, detector_.Detect(cloud_, geometry_));
}

void LidarConeDetectorNode::Publish(int64_t utime, const std::vector<DetectedCone>& cones) {
  const std::vector<ConeReturns> returns = ReturnsOf(cloud_, detector_.heights(), cones);
  const std::vector<ColourDistribution> colours = colours_.Classify(returns);
  const cone_clusters_t clusters =
      ToClustersMessage(utime, cones, returns, colours, SectorsLookedAt(cloud_, kMaxSectors),
                        params_.detector.max_range);
  bus_.Publish(channels::kConeClusters, clusters);
  bus_.Publish(channels::kConesLidar, ToConesMessage(clusters));
}

LidarConeDetectorNodeParams LoadLidarConeDetectorParams(const Config& config) {
  LidarConeDetectorNodeParams params;
  params.detector = LoadDetectorParams(config);
  params.colour = LoadColourParams(config);
  const Config input = config.Section("input");
  params.pairing.max_wait = input.Number("max_wait_s", {0.0, 0.2});
  params.pairing.period = 1.0 / channels::kLidarFront.rate_hz;
  params.pairing.deadline = channels::kLidarFront.deadline_s;
  params.max_speed = input.Number("max_speed_mps", {1.0, 200.0});
  params.max_yaw_rate = input.Number("max_yaw_rate_radps", {0.1, 100.0});
  const Car car = LoadCar(config);
  params.body = BodyOf(car, input.Number("body_margin_m", {0.0, 1.0}));
  params.T_base_sensor = {car.lidar_front.Transform().cast<float>(),
                          car.lidar_top.Transform().cast<float>()};
  config.Finish();
  return params;
}

}  // namespace hairpin
