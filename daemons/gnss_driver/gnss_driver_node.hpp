#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus.hpp"
#include "common/clock.hpp"
#include "common/config.hpp"
#include "common/local_enu.hpp"
#include "daemons/gnss_driver/gnss_driver.hpp"
#include "daemons/gnss_driver/serial_port.hpp"

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

/// Owns the serial port; publishes GNSS for each fix. A port that is absent or goes away is tried
/// again each second.
class GnssDriverNode {
 public:
  /// `clock`, monotonic, and `bus` must outlive the node.
  GnssDriverNode(const GnssDriverParams& params, Bus& bus, const Clock& clock);
  GnssDriverNode(const GnssDriverNode&) = delete;
  GnssDriverNode& operator=(const GnssDriverNode&) = delete;

  /// The port, while it is open.
  std::vector<int> descriptors() const;
  /// Reads what has come.
  void Poll();

 private:
  void TryToOpen();
  void Publish(const GnssFix& fix);
  void ReportBad();
  void Warn(const std::string& why);

  GnssDriverParams params_;
  Bus& bus_;
  const Clock& clock_;
  GnssDecoder decoder_;
  std::optional<LocalEnu> plane_;
  std::unique_ptr<SerialPort> port_;
  std::optional<int64_t> last_try_;
  std::map<std::string, int64_t> reported_;
  std::optional<int64_t> last_warning_;
};

}  // namespace hairpin
