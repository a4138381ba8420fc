#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemons/lidar_driver/lidar_driver.hpp"

namespace hairpin {

/// "192.168.1.201" in host byte order; empty for anything else.
std::optional<uint32_t> ParseIpv4(const std::string& text);

/// A UDP socket on one port, with the kernel's receive time of each packet. The first packets after
/// the socket opens may bear the time they were read: the kernel starts its stamping in the
/// background (net_enable_timestamp, Linux net/core/dev.c).
class UdpReceiver {
 public:
  /// Throws std::runtime_error where the port cannot be bound. `buffer_bytes` is asked of the
  /// kernel, which grants what net.core.rmem_max allows.
  UdpReceiver(uint16_t port, int buffer_bytes);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// Hands on what is waiting, at most `max_packets`; does not wait. Throws std::runtime_error
  /// where receiving fails.
  void Receive(int max_packets, const std::function<void(const LidarPacket&)>& handler);

  int descriptor() const { return socket_; }
  uint16_t port() const { return port_; }
  /// Packets that the kernel dropped for want of room.
  uint32_t overflows() const { return overflows_; }

 private:
  void ReadControl(msghdr& message, LidarPacket& packet);

  uint16_t port_;
  int socket_;
  uint32_t overflows_ = 0;
  std::vector<uint8_t> buffer_;
};

}  // namespace hairpin
