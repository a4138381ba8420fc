#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/bus.hpp"
#include "common/config.hpp"
#include "common/local_enu.hpp"
#include "daemons/gnss_driver/gnss_driver.hpp"

namespace hairpin {

struct GnssDriverParams {
  std::string port;
  int baud_rate = 0;
  GeodeticPoint origin;               // of local ENU
  bool origin_is_first_fix = false;   // in place of `origin`
  double antenna_baseline_yaw = 0.0;  // rad, of the line of antennas against base's x axis
  GnssErrorModel errors;
};

/// Reads `gnss_driver.yaml`. Throws ConfigError.
GnssDriverParams LoadGnssDriverParams(const Config& config);

/// The message that tells of a fix: the position on `plane`, zero where there is none, and the
/// heading of base's x axis, whose line of antennas is turned by `antenna_baseline_yaw` [rad].
/// FIX_NONE without a velocity: as far as the estimator goes there is no fix then.
gnss_t ToMessage(const GnssFix& fix, const LocalEnu* plane, double antenna_baseline_yaw);

/// Publishes GNSS for each fix. In its heartbeats, what the receiver sent stands as the channel
/// "serial": `received` are fixes, `undecodable` frames thrown away, `implausible_time` fixes not
/// published since their time does not increase.
class GnssDriverNode {
 public:
  /// `bus` must outlive the node.
  GnssDriverNode(const GnssDriverParams& params, Bus& bus);
  GnssDriverNode(const GnssDriverNode&) = delete;
  GnssDriverNode& operator=(const GnssDriverNode&) = delete;

  /// What has come from the receiver, in pieces of any size.
  void OnBytes(Bytes bytes);

 private:
  void Publish(const GnssFix& fix);
  void CountBad();

  GnssDriverParams params_;
  Bus& bus_;
  channel_health_t& health_;
  GnssDecoder decoder_;
  std::optional<LocalEnu> plane_;
  std::map<std::string, int64_t> reported_;  // of what the decoder has thrown away, by reason
};

}  // namespace hairpin
