#include "tools/race/lockstep.hpp"

#include <algorithm>

namespace hairpin {
namespace {

constexpr int64_t kStatusPeriod = 20'000;  // us of data time between two PIPELINE_STATUS
constexpr int kWaitMs = 10;
constexpr int kShortWaitMs = 1;  // where what is waited for does not wake us
// A scan is out when the next packet after its end has been handled, and its cones then; with a
// LiDAR dead, the detector waits for it before it goes on with the other.
constexpr int64_t kScanAge = 115'000;        // us: a revolution, and a tick and a packet
constexpr int64_t kGnssAge = 100'000;        // us: an epoch is out in its own tick
constexpr int64_t kConesAge = kScanAge;      // with both LiDARs
constexpr int64_t kConesAgeOfOne = 180'000;  // with one

}  // namespace

Lockstep::Lockstep(Transport& transport, SensorLevel level, double patience)
    : transport_(transport), patience_(patience), bus_(transport, "lockstep", 1) {
  Listen(channels::kVelocity);
  Listen(channels::kDriveCommand);
  Listen(channels::kAsState);
  Listen(channels::kLocalMap);
  Listen(channels::kGlobalMap);
  Listen(channels::kTrack);
  const bool raw = level == SensorLevel::kRaw;
  if (raw) {
    Listen(channels::kLidarFront);
    Listen(channels::kLidarTop);
    Listen(channels::kGnss);
    answers_[channels::kConesLidar.name];
  }
  answers_[channels::kPipelineStatus.name];
  bus_.Subscribe(channels::kPipelineStatus, [this](const pipeline_status_t& message) {
    mode_ = static_cast<MapMode>(message.map_mode);
    Heard(channels::kPipelineStatus.name, message.utime);
  });
  bus_.Subscribe(channels::kVehicle,
                 [this](const vehicle_t& message) { vehicle_utime_ = message.utime; });
  bus_.Subscribe(channels::kConesFusion,
                 [this](const cones_t& message) { observed_[Pipeline::kFusion] = message.utime; });
  bus_.Subscribe(channels::kConesLidar, [this, raw](const cones_t& message) {
    observed_[Pipeline::kLidar] = message.utime;
    if (raw) Heard(channels::kConesLidar.name, message.utime);
  });
  bus_.Subscribe(channels::kConesCamera,
                 [this](const cones_t& message) { observed_[Pipeline::kCamera] = message.utime; });
}

template <class M>
void Lockstep::Listen(const Channel<M>& channel) {
  answers_[channel.name];
  bus_.Subscribe(channel,
                 [this, name = channel.name](const M& message) { Heard(name, message.utime); });
}

void Lockstep::Heard(const std::string& channel, int64_t utime) {
  Answer& answer = answers_.at(channel);
  answer.newest = std::max(answer.newest, utime);
  answer.silent = false;
}

int64_t Lockstep::Wanted(const std::string& channel, int64_t utime) const {
  if (channel == channels::kPipelineStatus.name) return utime - kStatusPeriod;
  if (channel == channels::kAsState.name) return vehicle_utime_;
  const std::string front = channels::kLidarFront.name;
  const std::string top = channels::kLidarTop.name;
  if (channel == front || channel == top) return utime - kScanAge;
  if (channel == channels::kGnss.name) return utime - kGnssAge;
  if (channel == channels::kConesLidar.name) {
    const bool both = !answers_.at(front).silent && !answers_.at(top).silent;
    return utime - (both ? kConesAge : kConesAgeOfOne);
  }
  const bool answers_cones = channel == channels::kLocalMap.name ||
                             channel == channels::kGlobalMap.name ||
                             channel == channels::kTrack.name;
  if (!answers_cones) return utime;
  int64_t wanted = 0;
  for (const auto& [pipeline, observed] : observed_) {
    if (Uses(mode_, pipeline)) wanted = std::max(wanted, observed);
  }
  return wanted;
}

bool Lockstep::Answered(int64_t utime) const {
  return std::all_of(answers_.begin(), answers_.end(), [&](const auto& entry) {
    return entry.second.silent || entry.second.newest >= Wanted(entry.first, utime);
  });
}

void Lockstep::Await(int64_t utime, const std::function<bool()>& also) {
  transport_.Drain();
  const int64_t start = clock_.NowMicros();
  bool also_answered = also();
  if (also_answered) also_silent_ = false;
  while (!Answered(utime) || !(also_answered || also_silent_)) {
    transport_.Handle(also_answered || also_silent_ ? kWaitMs : kShortWaitMs);
    also_answered = also_answered || also();
    if (SecondsBetween(start, clock_.NowMicros()) < patience_) continue;
    ++missed_;
    also_silent_ = !also_answered;
    for (auto& [channel, answer] : answers_)
      answer.silent = answer.silent || answer.newest < Wanted(channel, utime);
  }
}

bool Lockstep::AnyoneSilent() const {
  return also_silent_ || std::any_of(answers_.begin(), answers_.end(),
                                     [](const auto& entry) { return entry.second.silent; });
}

}  // namespace hairpin
