#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/lidar_scan.hpp"

namespace hairpin {

inline constexpr size_t kNumLidars = 2;

/// One sensor's revolution.
struct LidarRevolution {
  int64_t utime = 0;
  std::vector<float> ring_elevation;
  float azimuth_step = 0.0f;
  double duration = 0.0;  // age of the oldest point [s]
  std::vector<LidarPoint> points;
};

/// What goes into one detection: a revolution of each sensor, or of some.
struct ScanSet {
  std::array<std::optional<LidarRevolution>, kNumLidars> scans;
  int64_t utime = 0;  // newest of them
};

struct ScanPairingParams {
  double max_wait = 0.0;  // for the partner of a scan [s]
  double period = 0.0;    // between revolutions of one sensor [s]
  double deadline = 0.0;  // a sensor silent for so long is not waited for [s]
};

/// Puts together revolutions of about the same time. A scan waits for its partner until data time
/// has gone on for `max_wait`, or not at all if the partner has been silent for its deadline: a
/// dead sensor costs latency only at first.
class ScanPairing {
 public:
  explicit ScanPairing(const ScanPairingParams& params) : params_(params) {}

  /// A scan of sensor `lidar`, whose place must be free: see MakeRoom(). Returns false, and drops
  /// it, where its time does not increase.
  bool Add(size_t lidar, LidarRevolution scan);
  /// While the sensor's last scan still waits: the next set, oldest first. To be called until
  /// nothing comes.
  std::optional<ScanSet> MakeRoom(size_t lidar);
  /// The next set that is complete, or has waited long enough at data time `now`.
  std::optional<ScanSet> Take(int64_t now);

 private:
  size_t Oldest() const;
  /// The oldest waiting scan, with its partner if that is there.
  ScanSet TakeOldest();

  ScanPairingParams params_;
  std::array<std::optional<LidarRevolution>, kNumLidars> waiting_;
  std::array<int64_t, kNumLidars> last_utime_{};
};

}  // namespace hairpin
