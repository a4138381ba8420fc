#include "daemons/lidar_cone_detector/conversion.hpp"
#include "tools/evaluation/lidar_sources.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/evaluation/recorded_sensor.hpp"
#include "tools/evaluation/stopwatch.hpp"

namespace hairpin {
namespace {

constexpr double kReach = 30.0;  // m: farther cones are not looked for

std::vector<TrueCone> InBase(const std::vector<SurveyedCone>& map, const Pose2& T_map_base) {
  std::vector<TrueCone> cones;
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
  const RecordedSensor sensor;
  const int keep_every = RecordedSensor::kRings / rings;
  const std::vector<SensorGeometry> sensors{sensor.Geometry(keep_every)};
  LidarConeDetector detector(params.detector);
  const ColourClassifier classifier(params.colour);
  Stopwatch stopwatch;
  detector.OnStageDone([&stopwatch](DetectorStage stage) { stopwatch.Record(stage); });
  RecordedScanReader reader(run);
  PointCloud cloud;
  for (int64_t number = 0; const std::optional<RecordedScan> scan = reader.Next(); ++number) {
    sensor.ToCloud(*scan, keep_every, cloud);
    const std::vector<DetectedCone>& cones = detector.Detect(cloud, sensors);
    std::vector<LidarDetection> detections;
    const std::vector<ColourDistribution> colours =
        classifier.Classify(ReturnsOf(cloud, detector.heights(), cones));
    for (size_t i = 0; i < cones.size(); ++i)
      detections.push_back({cones[i].position.cast<double>(), colours[i]});
    std::vector<TrueCone> truth = InBase(surveyed, scan->T_map_base);
    CountReturns(cloud, truth);
    listener({number, cloud, detector, truth, detections,
              sensors[0].T_base_sensor.translation().head<2>().cast<double>(), stopwatch.Laps()});
  }
}

}  // namespace hairpin
