#include "tools/simulator/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"
#include "tools/simulator/require.hpp"
#include "tools/simulator/truth.hpp"

namespace hairpin {
namespace {

// Ticks between messages, by the channel table's nominal rates.
template <class M>
int64_t Period(const Channel<M>& channel) {
  return std::llround(1.0 / (channel.rate_hz * Simulator::kTick));
}

template <class M>
double PeriodSeconds(const Channel<M>& channel) {
  return 1.0 / channel.rate_hz;
}

int Ticks(double duration) { return static_cast<int>(std::lround(duration / Simulator::kTick)); }

}  // namespace

Simulator::Simulator(const SimulatorParams& params, const Car& car, const Track& track,
                     uint64_t seed, Bus& bus, CanPort* can)
    : params_(params),
      track_(track),
      seed_(seed),
      bus_(bus),
      utime_(AddSeconds(kFirstUtime, -kTick)),
      vehicle_(params.vehicle, car, track.start),
      actuators_(params.actuators, car),
      motion_(params.motion_sensors, car, seed),
      referee_(params.referee, car, track),
      race_control_(params.race_control, car),
      gnss_receiver_(
          {params.gnss_receiver.protocol, track.origin.value_or(params.gnss_receiver.origin)}) {
  RequireWithin("cone_delay", params.cone_delay_s, 0.0, 0.5);
  const auto add = [&](const char* source, const Channel<cones_t>& channel,
                       const ConeSensorParams& sensor) {
    pipelines_.push_back(
        {source, channel, ConeSensor(sensor, source, seed), Ticks(sensor.phase_s)});
  };
  add("fusion", channels::kConesFusion, params.fusion);
  add("lidar", channels::kConesLidar, params.lidar);
  add("camera", channels::kConesCamera, params.camera);
  for (const std::string& source : Sources()) sources_[source] = true;
  if (can != nullptr) can_.emplace(*can);
  if (!can_) ListenToCommands();
}

void Simulator::ListenToCommands() {
  bus_.Subscribe(channels::kDriveCommand, [this](const drive_command_t& command) {
    const std::string problem = actuators_.OnCommand(command, utime_);
    if (!problem.empty()) bus_.Refuse(channels::kDriveCommand, problem);
  });
  bus_.Subscribe(channels::kAsState, [this](const as_state_t& state) {
    const std::string problem = actuators_.OnState(state, utime_);
    if (!problem.empty()) bus_.Refuse(channels::kAsState, problem);
  });
}

const std::vector<std::string>& Simulator::Sources() {
  static const std::vector<std::string> kSources{"fusion", "lidar",        "camera",   "imu",
                                                 "wheels", "ground_speed", "steering", "gnss"};
  return kSources;
}

void Simulator::SetSource(const std::string& source, bool on) {
  const auto found = sources_.find(source);
  if (found == sources_.end()) {
    std::string names;
    for (const std::string& name : Sources()) names += (names.empty() ? "" : ", ") + name;
    throw std::invalid_argument("no source " + source + "; there are: " + names);
  }
  found->second = on;
}

void Simulator::Step() {
  if (can_) can_->Receive(actuators_, utime_);
  if (++tick_ > 0) Advance();
  utime_ = AddSeconds(utime_, kTick);
  if (moved_listener_) moved_listener_();
  if (can_) can_->Begin(utime_);
  RefereeInput input;
  input.utime = utime_;
  input.driving = actuators_.state() == as_state_t::STATE_DRIVING;
  input.finished = actuators_.state() == as_state_t::STATE_FINISHED;
  input.emergency = actuators_.emergency();
  input.res_stop = actuators_.res_stop();
  referee_.Judge(input, vehicle_.state());
  if (tick_ % Period(channels::kTruthTrack) == 0) PublishTruthTrack();
  PublishTruth();
  if (tick_ % Period(channels::kVehicle) == 0) PublishVehicle();
  for (PipelineRun& pipeline : pipelines_) PublishCones(pipeline);
  PublishMotion();
  if (can_) can_->Flush();
}

bool Simulator::AwaitCan() {
  if (!can_) return true;
  can_->Receive(actuators_, utime_);
  can_->RepeatTime();
  return can_->command_utime() >= utime_ && can_->state_utime() >= vehicle_utime_;
}

template <class M>
void Simulator::PublishMeasured(const Channel<M>& channel, const M& message) {
  if (can_) return can_->Add(message);
  bus_.Publish(channel, message);
}

void Simulator::Advance() {
  const VehicleState& state = vehicle_.state();
  const VehicleInput input = actuators_.Act(utime_, state.steering_angle);
  vehicle_.Advance(input, static_cast<int>(std::lround(kTick / Vehicle::kStep)));
}

void Simulator::PublishCones(PipelineRun& pipeline) {
  if (tick_ % Period(pipeline.channel) == pipeline.phase_ticks) {
    pipeline.waiting.push_back(pipeline.sensor.Scan(utime_, vehicle_.state().T_map_base,
                                                    referee_.standing_cones(), track_.clutter));
  }
  const bool due = !pipeline.waiting.empty() &&
                   utime_ >= AddSeconds(pipeline.waiting.front().utime, params_.cone_delay_s);
  if (!due) return;
  if (IsOn(pipeline.source)) bus_.Publish(pipeline.channel, pipeline.waiting.front());
  pipeline.waiting.pop_front();
}

void Simulator::PublishMotion() {
  // All are measured, on or off: an axis' bias wanders on, and the streams stay in step.
  const VehicleState& state = vehicle_.state();
  const motors_t motors = motion_.Motors(utime_, state);
  const steering_t steering = motion_.Steering(utime_, state);
  const ground_speed_t ground_speed = motion_.GroundSpeed(utime_, state);
  const imu_t imu = motion_.Imu(utime_, state, PeriodSeconds(channels::kImu));
  if (IsOn("wheels")) PublishMeasured(channels::kMotors, motors);
  if (IsOn("steering")) PublishMeasured(channels::kSteering, steering);
  if (IsOn("ground_speed")) PublishMeasured(channels::kGroundSpeed, ground_speed);
  if (tick_ % Period(channels::kGnss) == 0) {
    const gnss_t gnss = motion_.Gnss(utime_, state, PeriodSeconds(channels::kGnss));
    if (IsOn("gnss")) PublishGnss(gnss);
  }
  if (IsOn("imu")) PublishMeasured(channels::kImu, imu);
}

void Simulator::PublishGnss(const gnss_t& gnss) {
  if (gnss_port_) return gnss_port_(gnss_receiver_.Epoch(gnss));
  bus_.Publish(channels::kGnss, gnss);
}

void Simulator::PublishVehicle() {
  if (race_control_.PressesStop(vehicle_.state())) actuators_.StopByRes();
  const vehicle_t vehicle = race_control_.Vehicle(utime_, actuators_, vehicle_.state());
  vehicle_utime_ = utime_;
  if (can_) return can_->Add(vehicle, vehicle_.state().brake);
  bus_.Publish(channels::kVehicle, vehicle);
}

void Simulator::PublishTruth() {
  truth_t message = TruthMessage(vehicle_.state(), utime_);
  message.lap = referee_.laps();
  message.cones_hit = result().cones_hit;
  message.off_course = result().off_course;
  bus_.Publish(channels::kTruth, message);
}

void Simulator::PublishTruthTrack() {
  bus_.Publish(channels::kTruthTrack, TruthTrackMessage(track_, utime_, seed_));
}

}  // namespace hairpin
