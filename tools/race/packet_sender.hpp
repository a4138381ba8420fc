#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "common/config.hpp"

namespace hairpin {

/// Sends the LiDARs' packets over UDP on loopback, to the ports that their drivers listen on.
class PacketSender {
 public:
  /// `config`: lidar_driver.yaml. Throws ConfigError, or std::runtime_error without a socket.
  explicit PacketSender(const Config& config);
  ~PacketSender();
  PacketSender(const PacketSender&) = delete;
  PacketSender& operator=(const PacketSender&) = delete;

  /// `sensor`: "lidar_front", "lidar_top". What the kernel does not take is lost, as on a wire.
  void Send(const std::string& sensor, bool position, std::span<const uint8_t> packet);

 private:
  struct Ports {
    uint16_t data;
    uint16_t position;
  };
  int socket_;
  std::map<std::string, Ports> ports_;
};

}  // namespace hairpin
