#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace hairpin {

/// Numbered as in velocity_t.
enum class SensorState { kUnknown = 0, kUsed = 1, kRejected = 2, kSilent = 3 };

struct SensorMonitorParams {
  double reject_after = 0.0;   // s of rejection in a row until a sensor is taken out
  double readmit_after = 0.0;  // s of agreement in a row until it is taken back
  double frozen_after = 0.0;   // s of the very same reading until it counts as frozen
};

/// Watches over one sensor: a single reading that fails its gate is left out, a sensor whose
/// readings keep failing is taken out, and must agree for longer before it is believed again
/// (FAULTS 9). All times are data time.
class SensorMonitor {
 public:
  SensorMonitor(const SensorMonitorParams& params, double deadline_s)
      : params_(params), deadline_(deadline_s) {}

  /// Judges the reading of `utime`. Returns whether to use it: it agrees, and the sensor is not
  /// out.
  bool Judge(int64_t utime, bool agrees);

  /// Takes the sensor out at once, or back: others have decided.
  void TakeOut(int64_t utime);
  void TakeBack() { is_out_ = false; }

  /// Forgets all judgements, but not since when the readings have been the very same.
  void Forgive();

  /// True once the same values have come for `frozen_after`, three times at least. Noise makes that
  /// impossible for a live sensor in motion; at standstill, where `moving` is false, a coarse one
  /// may repeat itself.
  bool IsFrozen(int64_t utime, const Eigen::Vector2d& reading, bool moving);

  /// Silent where nothing was judged within the deadline before `now`.
  SensorState StateAt(int64_t now) const;
  bool is_out() const { return is_out_; }

 private:
  SensorMonitorParams params_;
  double deadline_;
  bool is_out_ = false;
  bool last_agreed_ = true;
  std::optional<int64_t> last_utime_;
  int64_t streak_start_ = 0;  // of readings that all agree, or all fail
  Eigen::Vector2d reading_ = Eigen::Vector2d::Zero();
  std::optional<int64_t> reading_since_;
  int equal_readings_ = 0;
};

}  // namespace hairpin
