#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "daemons/gnss_driver/gnss_driver_node.hpp"
#include "daemons/gnss_driver/serial_port.hpp"

namespace hairpin {

/// The node with its serial port. A port that is absent or goes away is tried again each second.
class GnssDriverProcess {
 public:
  /// `clock`, monotonic, and `bus` must outlive this.
  GnssDriverProcess(const GnssDriverParams& params, Bus& bus, const Clock& clock);
  GnssDriverProcess(const GnssDriverProcess&) = delete;
  GnssDriverProcess& operator=(const GnssDriverProcess&) = delete;

  /// The port, while it is open.
  std::vector<int> descriptors() const;
  /// Reads what has come.
  void Poll();

 private:
  void TryToOpen();
  void Warn(const std::string& why);

  GnssDriverParams params_;
  std::string name_;
  const Clock& clock_;
  GnssDriverNode node_;
  std::unique_ptr<SerialPort> port_;
  std::optional<int64_t> last_try_;
  std::optional<int64_t> last_warning_;
};

}  // namespace hairpin
