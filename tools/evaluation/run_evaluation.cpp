#include "tools/evaluation/run_evaluation.hpp"

#include <cmath>
#include <set>

#include "common/channels.hpp"
#include "common/clock.hpp"
#include "daemons/lidar_cone_detector/conversion.hpp"
#include "tools/evaluation/recording_detector.hpp"
#include "tools/evaluation/recording_error.hpp"
#include "tools/report/statistics.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxSectors = 16;           // that local_mapper takes
constexpr int64_t kVelocityPeriod = 10'000;  // us, VELOCITY's 100 Hz
constexpr double kMaxInterpolation =
    0.2;  // s between two scans; a longer time is a gap in VELOCITY
// The recorder tells no covariance: what velocity_estimator claims of a car with all its sensors.
constexpr double kVelocitySigma = 0.05;  // m/s
constexpr double kYawRateSigma = 0.01;   // rad/s

Twist2 Between(const Twist2& a, const Twist2& b, double share) {
  return {std::lerp(a.vx, b.vx, share), std::lerp(a.vy, b.vy, share),
          std::lerp(a.yaw_rate, b.yaw_rate, share)};
}

/// local_mapper and global_mapper on a transport of their own.
class MappingChain {
 public:
  explicit MappingChain(const MappedRunParams& params)
      : local_node_(params.local_mapper, local_bus_),
        global_node_(params.global_mapper, global_bus_),
        max_range_(params.detector.detector.max_range) {
    sender_.Subscribe(channels::kGlobalMap, [this](const global_map_t& map) {
      driven_.emplace_back(map.x_m, map.y_m);
      newest_ = map;
    });
    sender_.Subscribe(channels::kLocalMap,
                      [this](const local_map_t& map) { epochs_.insert(map.epoch); });
  }

  void Feed(const DetectedScan& detected, const PointCloud& cloud) {
    const auto utime = static_cast<int64_t>(std::llround(1e6 * detected.scan.time));
    SendVelocities(utime, detected.scan.velocity);
    pipeline_status_t status{};
    status.utime = utime;
    status.map_mode = pipeline_status_t::MODE_LIDAR_ONLY;
    status.lidar_fresh = true;
    Send(channels::kPipelineStatus, status);
    Send(channels::kConesLidar,
         ToConesMessage(ToClustersMessage(utime, detected.cones, detected.returns, detected.colours,
                                          SectorsLookedAt(cloud, kMaxSectors), max_range_)));
  }

  const std::optional<global_map_t>& newest() const { return newest_; }
  const std::vector<Eigen::Vector2d>& driven() const { return driven_; }
  int epochs() const { return static_cast<int>(epochs_.size()); }

 private:
  /// The recorder's at each scan, linear between them.
  void SendVelocities(int64_t utime, const Twist2& velocity) {
    if (last_utime_ > 0 && SecondsBetween(last_utime_, utime) <= kMaxInterpolation) {
      for (int64_t t = last_utime_ + kVelocityPeriod; t < utime; t += kVelocityPeriod) {
        const double share = SecondsBetween(last_utime_, t) / SecondsBetween(last_utime_, utime);
        SendVelocity(t, Between(last_velocity_, velocity, share));
      }
    }
    SendVelocity(utime, velocity);
    last_utime_ = utime;
    last_velocity_ = velocity;
  }

  void SendVelocity(int64_t utime, const Twist2& velocity) {
    velocity_t message{};
    message.utime = utime;
    message.valid = true;
    message.vx_mps = velocity.vx;
    message.vy_mps = velocity.vy;
    message.yaw_rate_radps = velocity.yaw_rate;
    message.covariance[0] = message.covariance[4] = kVelocitySigma * kVelocitySigma;
    message.covariance[8] = kYawRateSigma * kYawRateSigma;
    Send(channels::kVelocity, message);
  }

  template <class M>
  void Send(const Channel<M>& channel, const M& message) {
    sender_.Publish(channel, message);
    transport_.Drain();
  }

  Transport transport_{"memq://"};
  Bus sender_{transport_, "evaluate", 1};
  Bus local_bus_{transport_, "local_mapper", 2};
  Bus global_bus_{transport_, "global_mapper", 3};
  LocalMapperNode local_node_;
  GlobalMapperNode global_node_;
  double max_range_;
  int64_t last_utime_ = 0;
  Twist2 last_velocity_;
  std::optional<global_map_t> newest_;
  std::vector<Eigen::Vector2d> driven_;
  std::set<int64_t> epochs_;
};

MapComparison Compare(const global_map_t& map, const std::vector<SurveyedCone>& survey,
                      const Pose2& T_survey_map) {
  std::vector<EstimatedCone> cones;
  for (const global_cone_t& cone : map.cones)
    cones.push_back({{cone.x_m, cone.y_m}, ColourOf(cone)});
  std::vector<Eigen::Vector2d> truth;
  truth.reserve(survey.size());
  for (const SurveyedCone& cone : survey) truth.push_back(cone.position);
  return CompareCones(cones, truth, T_survey_map);
}

}  // namespace

MappedRun MapRecording(const std::string& run, const std::vector<SurveyedCone>& survey,
                       const MappedRunParams& params) {
  RecordingDetector recording(run, params.rings, params.detector);
  MappingChain chain(params);
  MappedRun mapped;
  std::optional<Pose2> T_survey_map;  // the map begins where the car is at the first global map
  while (const std::optional<DetectedScan> detected = recording.Next()) {
    ++mapped.scans;
    const Twist2& velocity = detected->scan.velocity;
    mapped.max_speed = std::max(mapped.max_speed, std::hypot(velocity.vx, velocity.vy));
    chain.Feed(*detected, recording.cloud());
    if (!T_survey_map && chain.newest()) T_survey_map = detected->scan.T_map_base;
  }
  if (!chain.newest()) throw RecordingError(run + ": no map came of it");
  mapped.loop_closed = chain.newest()->phase == global_map_t::PHASE_LOOP_CLOSED;
  mapped.local_epochs = chain.epochs();
  mapped.comparison = Compare(*chain.newest(), survey, *T_survey_map);
  for (const Eigen::Vector2d& point : chain.driven())
    mapped.driven.push_back(*T_survey_map * point);
  return mapped;
}

nlohmann::json ToJson(const MappedRun& run) {
  nlohmann::json json = ToJson(std::optional(run.comparison));
  json["max_speed_mps"] = run.max_speed;
  json["scans"] = run.scans;
  json["local_epochs"] = run.local_epochs;
  json["loop_closed"] = run.loop_closed;
  return json;
}

}  // namespace hairpin
