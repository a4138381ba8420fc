#include "daemons/watchdog/map_mode_switch.hpp"

#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

// Rank for rising and falling: the two modes of a single sensor are equal, neither holds what the
// other knows.
int Rank(MapMode mode) {
  switch (mode) {
    case MapMode::kFusion:
      return 3;
    case MapMode::kLidarAndCamera:
      return 2;
    case MapMode::kLidarOnly:
    case MapMode::kCameraOnly:
      return 1;
    case MapMode::kNone:
    case MapMode::kUnknown:
      break;
  }
  return 0;
}

MapMode Decide(const PipelineFlags& flags) {
  return DecideMapMode(flags[static_cast<size_t>(Pipeline::kFusion)],
                       flags[static_cast<size_t>(Pipeline::kLidar)],
                       flags[static_cast<size_t>(Pipeline::kCamera)]);
}

// The best mode of at most this rank.
MapMode DecideUpTo(int rank, PipelineFlags flags) {
  if (rank < Rank(MapMode::kFusion)) flags[static_cast<size_t>(Pipeline::kFusion)] = false;
  const MapMode mode = Decide(flags);
  return Rank(mode) <= rank ? mode : rank > 0 ? MapMode::kLidarOnly : MapMode::kNone;
}

bool Carries(const PipelineFlags& fresh, MapMode mode) {
  for (size_t i = 0; i < fresh.size(); ++i) {
    if (Uses(mode, static_cast<Pipeline>(i)) && !fresh[i]) return false;
  }
  return true;
}

}  // namespace

MapMode DecideMapMode(bool fusion, bool lidar, bool camera) {
  if (fusion) return MapMode::kFusion;
  if (lidar && camera) return MapMode::kLidarAndCamera;
  if (lidar) return MapMode::kLidarOnly;
  return camera ? MapMode::kCameraOnly : MapMode::kNone;
}

MapModeSwitch::MapModeSwitch(const MapModeSwitchParams& params)
    : params_(params), flaps_(params.flap_window_s, static_cast<size_t>(params.max_flaps) + 1) {
  if (params.max_flaps < 0) throw std::invalid_argument("MapModeSwitch: max_flaps must be >= 0");
  if (!(params.health_s > 0.0)) throw std::invalid_argument("MapModeSwitch: health_s must be > 0");
}

void MapModeSwitch::Update(int64_t utime, const PipelineFlags& fresh,
                           const PipelineFlags& healthy) {
  if (!Carries(fresh, mode_)) return Fall(utime, fresh);
  if (latched_) return;
  PipelineFlags trusted = healthy;
  for (size_t i = 0; i < trusted.size(); ++i) {
    // What carries the mode now needs no probation to carry the next.
    trusted[i] = trusted[i] || Uses(mode_, static_cast<Pipeline>(i));
  }
  const MapMode better = Decide(trusted);
  if (Rank(better) > Rank(mode_)) Rise(utime, better);
}

void MapModeSwitch::Fall(int64_t utime, const PipelineFlags& fresh) {
  const MapMode lost = mode_;
  mode_ = latched_ ? DecideUpTo(Rank(lost), fresh) : Decide(fresh);
  if (!falling_) {
    flaps_.Add(utime);
    fell_from_ = lost;
    fell_utime_ = utime;
  }
  falling_ = Rank(mode_) < Rank(lost);
  if (!latched_ && flaps_.Reached(utime)) {
    latched_ = true;
    mode_ = DecideUpTo(Rank(lost), fresh);
  }
}

void MapModeSwitch::Rise(int64_t utime, MapMode mode) {
  const bool made_good =
      Rank(mode) >= Rank(fell_from_) && SecondsBetween(fell_utime_, utime) < params_.health_s;
  if (falling_ && made_good) flaps_.RemoveNewest();
  mode_ = mode;
  falling_ = false;
}

}  // namespace hairpin
