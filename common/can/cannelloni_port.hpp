#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "common/can/can_port.hpp"
#include "common/clock.hpp"

namespace hairpin {

/// "127.0.0.1:20000".
struct UdpAddress {
  std::string host;
  uint16_t port = 0;
};

/// Throws std::invalid_argument, naming the text, where it is no IPv4 address with a port.
UdpAddress ParseUdpAddress(const std::string& text);

/// A CAN bus carried by UDP in cannelloni's format, for machines without CAN. Datagrams of others
/// than `remote` are counted as malformed.
class CannelloniPort final : public CanPort {
 public:
  /// `clock` is monotonic and must outlive the port. Throws std::runtime_error where the socket
  /// cannot be bound.
  CannelloniPort(const UdpAddress& local, const UdpAddress& remote, const Clock& clock);
  ~CannelloniPort() override;
  CannelloniPort(const CannelloniPort&) = delete;
  CannelloniPort& operator=(const CannelloniPort&) = delete;

  int descriptor() const override { return socket_; }
  std::optional<ReceivedFrame> Receive() override;
  void Send(std::span<const CanFrame> frames) override;
  CanState state() const override { return CanState::kActive; }
  const CanPortCounts& counts() const override { return counts_; }

 private:
  void ReadDatagram();

  const Clock& clock_;
  UdpAddress remote_;
  int socket_ = -1;
  uint8_t sequence_ = 0;
  std::deque<ReceivedFrame> waiting_;  // of one datagram
  CanPortCounts counts_;
};

}  // namespace hairpin
