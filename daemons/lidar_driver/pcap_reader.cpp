#include "daemons/lidar_driver/pcap_reader.hpp"

#include <pcap/pcap.h>

#include <algorithm>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kEthernetHeader = 14;
constexpr size_t kVlanTag = 4;
constexpr size_t kMinIpHeader = 20;
constexpr size_t kUdpHeader = 8;
constexpr uint16_t kIpv4 = 0x0800;
constexpr uint16_t kVlan = 0x8100;
constexpr uint8_t kUdp = 17;

using Bytes = std::span<const uint8_t>;

// Network byte order.
uint16_t Read16(Bytes bytes, size_t offset) {
  return static_cast<uint16_t>(bytes[offset] << 8 | bytes[offset + 1]);
}

uint32_t Read32(Bytes bytes, size_t offset) {
  return static_cast<uint32_t>(Read16(bytes, offset)) << 16 | Read16(bytes, offset + 2);
}

std::optional<Bytes> IpPacket(Bytes frame) {
  size_t header = kEthernetHeader;
  if (frame.size() < header + kVlanTag) return std::nullopt;
  if (Read16(frame, header - 2) == kVlan) header += kVlanTag;
  if (Read16(frame, header - 2) != kIpv4 || frame.size() < header + kMinIpHeader)
    return std::nullopt;
  return frame.subspan(header);
}

struct UdpPayload {
  Bytes payload;
  uint32_t sender;
  uint16_t port;
};

std::optional<UdpPayload> FindUdpPayload(Bytes frame) {
  const auto ip = IpPacket(frame);
  if (!ip) return std::nullopt;
  const Bytes packet = *ip;
  const size_t header = 4 * size_t{packet[0] & 0x0fu};
  const bool fragment = (Read16(packet, 6) & 0x3fffu) != 0;
  if (packet[0] >> 4 != 4 || packet[9] != kUdp || fragment || header < kMinIpHeader ||
      packet.size() < header + kUdpHeader)
    return std::nullopt;
  const size_t length = Read16(packet, header + 4);
  if (length < kUdpHeader || packet.size() < header + length) return std::nullopt;
  return UdpPayload{packet.subspan(header + kUdpHeader, length - kUdpHeader), Read32(packet, 12),
                    Read16(packet, header + 2)};
}

}  // namespace

struct PcapReader::Capture {
  pcap_t* file = nullptr;
  ~Capture() {
    if (file != nullptr) pcap_close(file);
  }
};

PcapReader::PcapReader(const std::string& path, std::vector<uint16_t> ports)
    : capture_(std::make_unique<Capture>()), ports_(std::move(ports)) {
  char error[PCAP_ERRBUF_SIZE] = "";
  capture_->file =
      pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, error);
  if (capture_->file == nullptr) throw std::runtime_error(path + ": " + error);
  if (pcap_datalink(capture_->file) != DLT_EN10MB)
    throw std::runtime_error(path + ": is no capture of Ethernet");
}

PcapReader::~PcapReader() = default;

std::optional<LidarPacket> PcapReader::Next() {
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  int result = 0;
  while ((result = pcap_next_ex(capture_->file, &header, &data)) == 1) {
    const auto udp = FindUdpPayload({data, header->caplen});
    if (!udp || (!ports_.empty() && std::ranges::find(ports_, udp->port) == ports_.end())) continue;
    // Asked for nanoseconds, libpcap puts them where microseconds stand.
    const int64_t utime = int64_t{header->ts.tv_sec} * 1'000'000 + header->ts.tv_usec / 1000;
    return LidarPacket{udp->payload, utime, udp->sender};
  }
  if (result == PCAP_ERROR_BREAK) return std::nullopt;
  throw std::runtime_error(pcap_geterr(capture_->file));
}

}  // namespace hairpin
