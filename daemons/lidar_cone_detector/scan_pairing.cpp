#include "daemons/lidar_cone_detector/scan_pairing.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"

namespace hairpin {

bool ScanPairing::Add(size_t lidar, LidarRevolution scan) {
  if (scan.utime <= last_utime_[lidar]) return false;
  last_utime_[lidar] = scan.utime;
  waiting_[lidar] = std::move(scan);
  return true;
}

size_t ScanPairing::Oldest() const {
  size_t oldest = kNumLidars;
  for (size_t i = 0; i < kNumLidars; ++i) {
    if (waiting_[i] && (oldest == kNumLidars || waiting_[i]->utime < waiting_[oldest]->utime))
      oldest = i;
  }
  return oldest;
}

ScanSet ScanPairing::TakeOldest() {
  ScanSet set;
  const int64_t first = waiting_[Oldest()]->utime;
  for (size_t i = 0; i < kNumLidars; ++i) {
    if (!waiting_[i] || SecondsBetween(first, waiting_[i]->utime) > 0.5 * params_.period) continue;
    set.utime = std::max(set.utime, waiting_[i]->utime);
    set.scans[i] = std::move(waiting_[i]);
    waiting_[i].reset();
  }
  return set;
}

std::optional<ScanSet> ScanPairing::MakeRoom(size_t lidar) {
  if (!waiting_[lidar]) return std::nullopt;
  return TakeOldest();
}

std::optional<ScanSet> ScanPairing::Take(int64_t now) {
  const size_t oldest = Oldest();
  if (oldest == kNumLidars) return std::nullopt;
  const int64_t utime = waiting_[oldest]->utime;
  bool partner_may_come = false;
  for (size_t i = 0; i < kNumLidars; ++i) {
    // One that waits too is either in the set or later than it: nothing to wait for.
    if (i == oldest || waiting_[i]) continue;
    partner_may_come |= SecondsBetween(last_utime_[i], now) < params_.deadline;
  }
  if (partner_may_come && SecondsBetween(utime, now) < params_.max_wait) return std::nullopt;
  return TakeOldest();
}

}  // namespace hairpin
