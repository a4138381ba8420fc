// What the watchdog costs per simulated second of the whole car's traffic. The time of publishing
// alone, without anybody who hears it, is to be taken off.

#include <benchmark/benchmark.h>

#include "daemons/watchdog/watchdog_node.hpp"

namespace hairpin {
namespace {

template <class M>
void Send(Bus& car, const Channel<M>& channel, M message, int64_t utime) {
  message.utime = utime;
  car.Publish(channel, std::move(message));
}

// One second: sensors, velocity and commands at 100 Hz, cones, maps and paths of a full track at 10
// Hz.
void SendOneSecond(Bus& car, Transport& transport, int64_t& now) {
  cones_t cones{};
  cones.cones.resize(static_cast<size_t>(cones.num_cones = 20));
  local_map_t map{};
  map.cones.resize(static_cast<size_t>(map.num_cones = 60));
  track_t track{};
  track.path.resize(static_cast<size_t>(track.num_points = 15));
  heartbeat_t heartbeat{};
  for (int tick = 0; tick < 100; ++tick) {
    now += 10'000;
    Send(car, channels::kMotors, motors_t{}, now);
    Send(car, channels::kSteering, steering_t{}, now);
    Send(car, channels::kGroundSpeed, ground_speed_t{}, now);
    Send(car, channels::kImu, imu_t{}, now);
    Send(car, channels::kVelocity, velocity_t{}, now);
    Send(car, channels::kDriveCommand, drive_command_t{}, now);
    if (tick % 5 == 0) {
      Send(car, channels::kVehicle, vehicle_t{}, now);
      Send(car, channels::kAsState, as_state_t{}, now);
    }
    if (tick % 10 == 0) {
      Send(car, channels::kGnss, gnss_t{}, now);
      Send(car, channels::kConesFusion, cones, now - 100'000);
      Send(car, channels::kConesLidar, cones, now - 100'000);
      Send(car, channels::kConesCamera, cones, now - 100'000);
      Send(car, channels::kLocalMap, map, now - 100'000);
      Send(car, channels::kTrack, track, now - 100'000);
      for (const char* daemon :
           {"velocity_estimator", "local_mapper", "path_tracker", "mission_manager"}) {
        heartbeat.daemon = daemon;
        Send(car, channels::kHeartbeat, heartbeat, now);
      }
    }
    transport.Drain();
  }
}

void PublishingAlone(benchmark::State& state) {
  Transport transport("memq://");
  Bus car(transport, "car", 1);
  int64_t now = 1'700'000'000'000'000;
  for (auto _ : state) SendOneSecond(car, transport, now);
}
BENCHMARK(PublishingAlone)->Unit(benchmark::kMillisecond);

void PublishingAndWatching(benchmark::State& state) {
  Transport transport("memq://");
  Bus car(transport, "car", 1);
  Bus bus(transport, "watchdog", 2);
  const ManualClock clock;
  WatchdogNode watchdog(LoadWatchdogParams(Config::Load(HAIRPIN_SOURCE_DIR "/config", "watchdog")),
                        bus, clock);
  int64_t now = 1'700'000'000'000'000;
  for (auto _ : state) SendOneSecond(car, transport, now);
}
BENCHMARK(PublishingAndWatching)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hairpin
