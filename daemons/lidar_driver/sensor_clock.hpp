#pragma once

#include <cstdint>
#include <optional>

#include "daemons/lidar_driver/position_packet.hpp"
#include "hairpin/lidar_scan_t.hpp"

namespace hairpin {

enum class TimeSource {
  kUnknown = lidar_scan_t::TIME_UNKNOWN,
  kGnss = lidar_scan_t::TIME_GNSS,
  kHost = lidar_scan_t::TIME_HOST,
  kHeld = lidar_scan_t::TIME_HELD,
};

struct SensorClockParams {
  double gnss_wait_s = 0.0;  // without GPS time for so long, the host's clock is taken instead
  double gnss_hold_s = 0.0;  // GPS time counts as lost when none was received for so long
  double restart_s = 0.0;    // a clock that went back is believed once it has advanced for so long
};

/// Turns a sensor's microseconds past the hour into microseconds since the Unix epoch. The hour is
/// that of the sensor's GPS receiver; where there is none, the first stamp is taken to be when the
/// host received it, and the sensor's clock counts on from there. All in sensor time: the host's
/// clock may jump afterwards without effect.
class SensorClock {
 public:
  explicit SensorClock(const SensorClockParams& params) : params_(params) {}

  /// A position packet with locked pulse and a whole sentence anchors the hour. Once anchored, a
  /// different hour is believed the second time in a row only.
  void Hear(const PositionPacket& position);

  /// Advances to a data packet's stamp. False where time does not advance: the same packet again,
  /// or a late one. After `restart_s` of a time of its own the sensor has been restarted: it is
  /// then anchored anew.
  bool Advance(uint32_t time_us, int64_t receive_utime);

  /// Of the newest data packet's stamp; empty while there is no anchor.
  std::optional<int64_t> utime() const;
  TimeSource source() const;

 private:
  /// Microseconds that count on over the hours.
  int64_t Unwrapped(uint32_t time_us) const;
  void Restart(uint32_t time_us);
  void Anchor(int64_t offset, TimeSource source);

  SensorClockParams params_;
  std::optional<int64_t> newest_;  // unwrapped stamp of the newest data packet
  int64_t started_ = 0;            // of the first one
  std::optional<int64_t> offset_;  // utime of unwrapped stamp 0
  TimeSource anchored_by_ = TimeSource::kUnknown;
  std::optional<int64_t> last_gps_;        // unwrapped stamp of the last good position packet
  std::optional<int64_t> claimed_offset_;  // by the last position packet, differing from offset_
  std::optional<PositionPacket> early_;    // heard before the first data packet
  // A time of its own that the sensor may have gone over to.
  uint32_t other_first_us_ = 0;
  std::optional<uint32_t> other_newest_us_;
};

}  // namespace hairpin
