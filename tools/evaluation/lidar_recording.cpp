#include "tools/evaluation/lidar_sources.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/evaluation/recording_detector.hpp"
#include "tools/evaluation/stopwatch.hpp"

namespace hairpin {
namespace {

constexpr double kReach = 30.0;  // m: farther cones are not looked for

std::vector<ScannedCone> InBase(const std::vector<SurveyedCone>& map, const Pose2& T_map_base) {
  std::vector<ScannedCone> cones;
  for (const SurveyedCone& cone : map) {
    const Eigen::Vector2d position = T_map_base.Inverse() * cone.position;
    if (position.norm() < kReach) cones.push_back({position, cone.colour, 0});
  }
  return cones;
}

}  // namespace

void DetectInRecording(const std::string& run, const std::string& map, int rings,
                       const LidarConeDetectorNodeParams& params, const ScanListener& listener) {
  const std::vector<SurveyedCone> surveyed = LoadSurveyedMap(map);
  RecordingDetector recording(run, rings, params);
  Stopwatch stopwatch;
  recording.detector().OnStageDone([&stopwatch](DetectorStage stage) { stopwatch.Record(stage); });
  for (int64_t number = 0; const std::optional<DetectedScan> found = recording.Next(); ++number) {
    std::vector<LidarDetection> detections;
    for (size_t i = 0; i < found->cones.size(); ++i)
      detections.push_back({found->cones[i].position.cast<double>(), found->colours[i]});
    std::vector<ScannedCone> truth = InBase(surveyed, found->scan.T_map_base);
    CountReturns(recording.cloud(), truth);
    listener({number, recording.cloud(), recording.detector(), truth, detections,
              recording.sensor_position(), stopwatch.Laps()});
  }
}

}  // namespace hairpin
