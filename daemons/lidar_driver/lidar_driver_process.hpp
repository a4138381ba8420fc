#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "daemons/lidar_driver/lidar_driver_node.hpp"
#include "daemons/lidar_driver/pcap_reader.hpp"
#include "daemons/lidar_driver/udp_receiver.hpp"

namespace hairpin {

/// The node with its sockets, or with a capture in their place.
class LidarDriverProcess {
 public:
  /// `pcap_file` is empty for the wire. `clock` paces a capture; it must outlive this, as `bus`
  /// must. Throws as LidarDriverNode, UdpReceiver and PcapReader do.
  LidarDriverProcess(const Config& config, Bus& bus, const std::string& pcap_file,
                     const Clock& clock);

  /// Takes what has come, or, of a capture, what would have come by now.
  void Poll();
  std::vector<int> descriptors() const;

 private:
  void PollCapture();

  LidarDriverNodeParams params_;
  LidarDriverNode node_;
  const Clock& clock_;
  std::vector<std::unique_ptr<UdpReceiver>> sockets_;
  std::unique_ptr<PcapReader> capture_;
  std::optional<LidarPacket> next_;  // of the capture
  int64_t capture_start_ = 0;        // first packet's time less the clock's then
};

}  // namespace hairpin
