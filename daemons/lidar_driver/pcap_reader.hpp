#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemons/lidar_driver/lidar_driver.hpp"

namespace hairpin {

/// The UDP payloads of a capture file, with the capture's times: IPv4 over Ethernet, one VLAN tag
/// allowed. Whatever else is in the file, fragments among it, is skipped. Reads with libpcap: both
/// byte orders, microseconds or nanoseconds, pcapng as well.
class PcapReader {
 public:
  /// `ports`: the destination ports that are wanted; all where it is empty. Throws
  /// std::runtime_error where the file cannot be read or is no capture of Ethernet.
  PcapReader(const std::string& path, std::vector<uint16_t> ports);
  ~PcapReader();
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// The next payload, valid until the next call; empty at the end. Throws std::runtime_error where
  /// the file breaks off.
  std::optional<LidarPacket> Next();

 private:
  struct Capture;
  std::unique_ptr<Capture> capture_;
  std::vector<uint16_t> ports_;
};

}  // namespace hairpin
