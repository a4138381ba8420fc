// hairpin-lidar-scans: records simulated LiDAR scans of a track, without anyone driving.
#include <CLI/CLI.hpp>
#include <iostream>

#include "common/clock.hpp"
#include "common/daemon.hpp"
#include "tools/report/log_writer.hpp"
#include "tools/simulator/lidar/centre_drive.hpp"
#include "tools/simulator/lidar/scan_recorder.hpp"
#include "tools/simulator/simulator.hpp"
#include "tools/simulator/truth.hpp"

namespace hairpin {
namespace {

struct Arguments {
  std::string track;
  std::string out;
  std::string config_dir;
  uint64_t seed = 1;
  double speed = 5.0;
  double duration = 10.0;
};

/// Messages with sequence numbers, into a log.
class Log {
 public:
  explicit Log(const std::string& file) : writer_(file) {}
  template <class M>
  void Write(const Channel<M>& channel, M message, int64_t utime) {
    message.boot_id = 1;
    message.sequence = sequences_[channel.name]++;
    writer_.Write(utime, channel, message);
  }
  void Close() { writer_.Close(); }

 private:
  LogWriter writer_;
  std::map<std::string, int32_t> sequences_;
};

velocity_t TrueVelocity(int64_t utime, const VehicleState& state) {
  velocity_t message{};
  message.utime = utime;
  message.valid = 1;
  message.vx_mps = state.velocity.vx;
  message.vy_mps = state.velocity.vy;
  message.yaw_rate_radps = state.velocity.yaw_rate;
  for (const int i : {0, 4, 8}) message.covariance[i] = 1e-4;
  message.acceleration_mps2[0] = state.acceleration.x();
  message.acceleration_mps2[1] = state.acceleration.y();
  return message;
}

void Record(const Arguments& arguments) {
  const Track track = LoadTrack(arguments.track);
  const Config config = Config::Load(arguments.config_dir, "simulator");
  const Car car = LoadCar(config);
  const SimulatorParams params = LoadSimulatorParams(config);
  const CentreDrive drive(track, arguments.speed);
  Log log(arguments.out);
  int64_t utime = Simulator::kFirstUtime;
  std::map<std::string, ScanRecorder> revolutions;
  for (const std::string& name : LidarRig::Sources())
    revolutions.emplace(name, ScanRecorder(params.lidars.sensor, utime));
  LidarRig rig(params.lidars, car, track, arguments.seed, utime,
               [](const std::string&, LidarRig::Port, std::span<const uint8_t>) {});
  rig.OnSequence([&](const std::string& sensor, const FiringSequence& sequence) {
    const auto scan = revolutions.at(sensor).Add(sequence);
    if (!scan) return;
    log.Write(sensor == "lidar_front" ? channels::kLidarFront : channels::kLidarTop, *scan, utime);
  });
  log.Write(channels::kTruthTrack, TruthTrackMessage(track, utime, arguments.seed), utime);
  const std::vector<TrackCone> cones = AllCones(track);
  for (double time = 0.0; time <= arguments.duration; time += Simulator::kTick) {
    const VehicleState state = drive.At(time);
    log.Write(channels::kTruth, TruthMessage(state, utime), utime);
    log.Write(channels::kVelocity, TrueVelocity(utime, state), utime);
    rig.Advance(utime, state, cones);
    utime = AddSeconds(utime, Simulator::kTick);
  }
  log.Close();
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Records what both LiDARs of a car see that follows a track's middle: an LCM log of "
      "LIDAR_FRONT, LIDAR_TOP, VELOCITY (true), TRUTH and TRUTH_TRACK.",
      "hairpin-lidar-scans");
  Arguments arguments;
  app.add_option("--track", arguments.track, "track file")->required()->check(CLI::ExistingFile);
  app.add_option("--out", arguments.out, "log to write")->required();
  app.add_option("--config-dir", arguments.config_dir, "folder of the .yaml files")->required();
  app.add_option("--seed", arguments.seed, "of noise, ground and clutter")->capture_default_str();
  app.add_option("--speed", arguments.speed, "of the car [m/s]")
      ->check(CLI::Range(0.1, 40.0))
      ->capture_default_str();
  app.add_option("--duration", arguments.duration, "of the recording [s]")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  try {
    Record(arguments);
  } catch (const TrackError& error) {
    std::cerr << "hairpin-lidar-scans: " << error.what() << '\n';
    return kExitConfig;
  } catch (const ConfigError& error) {
    std::cerr << "hairpin-lidar-scans: " << error.what() << '\n';
    return kExitConfig;
  } catch (const std::exception& error) {
    std::cerr << "hairpin-lidar-scans: " << error.what() << '\n';
    return kExitFailure;
  }
  return 0;
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
