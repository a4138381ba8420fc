#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/bus.hpp"
#include "common/can/can_port.hpp"
#include "common/car.hpp"
#include "tools/simulator/actuators.hpp"
#include "tools/simulator/can_car.hpp"
#include "tools/simulator/cone_sensor.hpp"
#include "tools/simulator/gnss_receiver.hpp"
#include "tools/simulator/motion_sensors.hpp"
#include "tools/simulator/race_control.hpp"
#include "tools/simulator/referee.hpp"
#include "tools/simulator/simulator_params.hpp"
#include "tools/simulator/track.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

/// The car, its sensors and the race around it, on a bus: publishes what drivers, perception and
/// the CAN gateway would, listens to DRIVE_COMMAND and AS_STATE. With a CAN port it speaks CAN in
/// their place, and leaves these messages to a gateway; with OnGnss() a receiver's bytes in place
/// of GNSS. With both, and its pipelines switched off, it publishes nothing but the truth. Advances
/// by Step() only, so that simulated time can wait for the stack's answer. The same seed and the
/// same commands give the same messages.
class Simulator {
 public:
  static constexpr double kTick = 0.01;  // s
  static constexpr int64_t kFirstUtime = 1'700'000'000'000'000;

  /// `can` must outlive the simulator. Throws std::invalid_argument for values that cannot be.
  Simulator(const SimulatorParams& params, const Car& car, const Track& track, uint64_t seed,
            Bus& bus, CanPort* can = nullptr);

  /// One tick of 10 ms: the last commands act on the car, then the sensors publish, IMU last. The
  /// first tick publishes the car as it stands, at kFirstUtime.
  void Step();

  /// Calls `listener` in each Step(), once the car has moved and before anything is published: for
  /// sensors outside, whose data of a tick must be out before the IMU's message ends it.
  void OnMoved(std::function<void()> listener) { moved_listener_ = std::move(listener); }

  /// GNSS leaves through the receiver's serial port from now on, and as no message: calls `port`
  /// with the bytes of each epoch.
  void OnGnss(std::function<void(std::span<const uint8_t>)> port) { gnss_port_ = std::move(port); }

  /// Time of the last tick; kFirstUtime less one tick before the first.
  int64_t utime() const { return utime_; }
  /// The race is over. Step() may still be called.
  bool done() const { return referee_.done(); }
  const RaceResult& result() const { return referee_.result(); }
  const VehicleState& vehicle() const { return vehicle_.state(); }
  /// Cones not yet knocked down, in the track's order: left, right, others.
  const std::vector<TrackCone>& standing_cones() const { return referee_.standing_cones(); }
  const Actuators& actuators() const { return actuators_; }

  /// True once a gateway has answered this tick's frames by CAN, with a command and a state. To be
  /// asked while time waits for the stack; takes what has arrived, and keeps the bus alive. Always
  /// true without CAN.
  bool AwaitCan();

  /// Names that SetSource() knows.
  static const std::vector<std::string>& Sources();
  /// Makes a source cease to publish at once, or resume. The noise of all others stays what it
  /// would have been. Throws std::invalid_argument, with the names there are, for another name.
  void SetSource(const std::string& source, bool on);
  /// Presses the remote emergency stop.
  void RequestResStop() { actuators_.StopByRes(); }

 private:
  /// A pipeline at work: scans that have been taken and wait for their delay to pass.
  struct PipelineRun {
    std::string source;
    Channel<cones_t> channel;
    ConeSensor sensor;
    int phase_ticks;
    std::deque<cones_t> waiting{};
  };

  bool IsOn(const std::string& source) const { return sources_.at(source); }
  void ListenToCommands();
  template <class M>
  void PublishMeasured(const Channel<M>& channel, const M& message);
  void Advance();
  void PublishTruth();
  void PublishTruthTrack();
  void PublishGnss(const gnss_t& gnss);
  void PublishVehicle();
  void PublishCones(PipelineRun& pipeline);
  void PublishMotion();

  SimulatorParams params_;
  Track track_;
  uint64_t seed_;
  Bus& bus_;
  int64_t tick_ = -1;
  int64_t utime_;
  Vehicle vehicle_;
  Actuators actuators_;
  MotionSensors motion_;
  std::vector<PipelineRun> pipelines_;
  Referee referee_;
  RaceControl race_control_;
  std::optional<CanCar> can_;
  int64_t vehicle_utime_ = 0;  // of the last VEHICLE
  std::map<std::string, bool> sources_;
  std::function<void()> moved_listener_;
  GnssReceiver gnss_receiver_;
  std::function<void(std::span<const uint8_t>)> gnss_port_;
};

}  // namespace hairpin
