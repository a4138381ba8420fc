#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "common/daemon.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/lidar_evaluation.hpp"
#include "tools/evaluation/lidar_picture.hpp"
#include "tools/evaluation/recorded_scans.hpp"
#include "tools/evaluation/recorded_sensor.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

struct LidarOptions {
  std::string run, map;
  std::string config_dir = "config";
  std::vector<std::string> overrides;
  int rings = 64;
  bool json = false;
  std::optional<int64_t> picture;
  std::string out;
};

void DefineOptions(CLI::App& app, LidarOptions& options) {
  app.add_option("--run", options.run, "recorded scans (.fscn.xz)")->required();
  app.add_option("--map", options.map, "surveyed cones (.csv: x_m,y_m,colour)")->required();
  app.add_option("--rings", options.rings, "of the 64 recorded: 32 leaves out every second one")
      ->check(CLI::IsMember({64, 32, 16}))
      ->capture_default_str();
  app.add_option("--config-dir", options.config_dir, "folder of the .yaml files")
      ->envname("HAIRPIN_CONFIG_DIR")
      ->capture_default_str();
  app.add_option("--set", options.overrides,
                 "KEY=VALUE in place of the config file's value (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--json", options.json, "print one JSON object");
  CLI::Option* picture = app.add_option("--picture", options.picture, "draw this scan");
  picture->needs(app.add_option("--out", options.out, "the picture's .svg file")->needs(picture));
}

class Stopwatch {
 public:
  void Start() {
    laps_.clear();
    start_ = last_ = std::chrono::steady_clock::now();
  }
  void Lap() {
    const auto now = std::chrono::steady_clock::now();
    laps_.push_back(Milliseconds(now - last_));
    last_ = now;
  }
  /// The laps, and all of it.
  std::vector<double> Stop() {
    laps_.push_back(Milliseconds(std::chrono::steady_clock::now() - start_));
    return laps_;
  }

 private:
  static double Milliseconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
  }
  std::chrono::steady_clock::time_point start_, last_;
  std::vector<double> laps_;
};

std::vector<TrueCone> InBase(const std::vector<SurveyedCone>& map, const Pose2& T_map_base) {
  constexpr double kReach = 30.0;  // m
  std::vector<TrueCone> cones;
  for (const SurveyedCone& cone : map) {
    const Eigen::Vector2d position = T_map_base.Inverse() * cone.position;
    if (position.norm() < kReach) cones.push_back({position, cone.colour, 0});
  }
  return cones;
}

std::vector<LidarDetection> ToDetections(const std::vector<DetectedCone>& cones) {
  std::vector<LidarDetection> detections;
  for (const DetectedCone& cone : cones)
    detections.push_back({cone.position.cast<double>(), kColourUnknown});
  return detections;
}

void Run(const LidarOptions& options) {
  const Config config = Config::Load(options.config_dir, "lidar_cone_detector", options.overrides);
  const LidarConeDetectorNodeParams params = LoadLidarConeDetectorParams(config);
  const std::vector<SurveyedCone> map = LoadSurveyedMap(options.map);
  const RecordedSensor sensor;
  const int keep_every = 64 / options.rings;
  const std::vector<SensorGeometry> sensors{sensor.Geometry(keep_every)};
  const Eigen::Vector2d place = sensors[0].T_base_sensor.translation().head<2>().cast<double>();
  LidarConeDetector detector(params.detector);
  Stopwatch stopwatch;
  detector.OnStageDone([&stopwatch](DetectorStage) { stopwatch.Lap(); });

  RecordedScanReader reader(options.run);
  LidarFigures figures;
  PointCloud whole, cloud;
  int64_t number = 0;
  while (const std::optional<RecordedScan> scan = reader.Next()) {
    sensor.ToCloud(*scan, keep_every, whole);
    params.body.RemoveFrom(whole, cloud);
    stopwatch.Start();
    const std::vector<DetectedCone>& cones = detector.Detect(cloud, sensors);
    const std::vector<double> ms = stopwatch.Stop();
    std::vector<TrueCone> truth = InBase(map, scan->T_map_base);
    CountReturns(cloud, truth);
    const std::vector<LidarDetection> detections = ToDetections(cones);
    figures.Add(truth, detections, place, ms);
    if (options.picture == number)
      WriteFile(options.out, DrawScan(number, cloud, detector.heights(), detector.candidates(),
                                      truth, detections));
    ++number;
  }
  if (options.picture && *options.picture >= number)
    throw RecordingError("--picture " + std::to_string(*options.picture) +
                         ": the run has scans 0 to " + std::to_string(number - 1));
  PrintFigures(figures.ToJson(), options.json);
}

}  // namespace

void AddLidarCommand(CLI::App& app) {
  CLI::App* lidar = app.add_subcommand("lidar", "lidar_cone_detector on recorded scans");
  const auto options = std::make_shared<LidarOptions>();
  DefineOptions(*lidar, *options);
  lidar->callback([options] { Run(*options); });
}

}  // namespace hairpin
