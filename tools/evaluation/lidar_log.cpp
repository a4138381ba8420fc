#include "common/channels.hpp"
#include "common/clock.hpp"
#include "tools/evaluation/lidar_sources.hpp"
#include "tools/evaluation/recording_error.hpp"
#include "tools/evaluation/stopwatch.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

constexpr double kReach = 30.0;  // m: farther cones are not looked for

bool IsReplayed(const std::string& channel) {
  return channel == channels::kLidarFront.name || channel == channels::kLidarTop.name ||
         channel == channels::kVelocity.name;
}

/// The node between a log and the truth that the log holds.
class Replay {
 public:
  /// `log` must outlive this.
  Replay(const RunLog& log, const LidarConeDetectorNodeParams& params, ScanListener listener)
      : trajectory_(log),
        track_(log.truth_track),
        params_(params),
        listener_(std::move(listener)),
        node_(params, bus_) {
    node_.OnStageDone([this](DetectorStage stage) { stopwatch_.Record(stage); });
    observer_.Subscribe(channels::kConesLidar, [this](const cones_t& m) { OnCones(m); });
  }

  void Feed(const LogEvent& event) {
    transport_.Publish(event.channel, event.data.data(), event.data.size());
    transport_.Drain();
  }
  int64_t scans() const { return scans_; }

 private:
  void OnCones(const cones_t& message) {
    const std::optional<TrueState> state = trajectory_.At(message.utime);
    if (!state || !track_) return;
    const Pose2 T_base_map = state->T_map_base.Inverse();
    std::vector<ScannedCone> truth;
    for (const truth_cone_t& cone : track_->cones) {
      const auto colour = static_cast<ConeColour>(cone.colour);
      const Eigen::Vector2d position = T_base_map * Eigen::Vector2d(cone.x_m, cone.y_m);
      if (position.norm() < kReach) truth.push_back({position, colour, 0});
    }
    CountReturns(node_.cloud(), truth);
    std::vector<LidarDetection> detections;
    for (const cone_observation_t& cone : message.cones) {
      if (const auto observation = ToConeObservation(cone))
        detections.push_back({observation->position, observation->colour});
    }
    listener_({scans_++, node_.cloud(), node_.detector(), truth, detections,
               params_.T_base_sensor[0].translation().head<2>().cast<double>(), stopwatch_.Laps()});
  }

  TrueTrajectory trajectory_;
  const std::optional<truth_track_t>& track_;
  LidarConeDetectorNodeParams params_;
  ScanListener listener_;
  Transport transport_{"memq://"};
  Bus bus_{transport_, "lidar_cone_detector", 1};
  Bus observer_{transport_, "evaluate", 2};
  LidarConeDetectorNode node_;
  Stopwatch stopwatch_;
  int64_t scans_ = 0;
};

}  // namespace

void DetectInLog(const std::string& log, const LidarConeDetectorNodeParams& params,
                 const ScanListener& listener) {
  const RunLog run = LoadRunLog(log);
  Replay replay(run, params, listener);
  LogReader reader(log);
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (IsReplayed(event->channel)) replay.Feed(*event);
  }
  if (replay.scans() == 0)
    throw RecordingError(log + ": holds no LIDAR_* scans with VELOCITY, TRUTH and TRUTH_TRACK");
}

}  // namespace hairpin
