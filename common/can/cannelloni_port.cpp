#include "common/can/cannelloni_port.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "common/can/cannelloni.hpp"

namespace hairpin {
namespace {

constexpr int kReceiveBuffer = 1 << 20;      // a second of a full bus, and more
constexpr size_t kMaxDatagram = 65'507;      // of UDP
constexpr int kMaxDatagramsPerReceive = 64;  // empty or malformed ones skipped in one call

sockaddr_in ToSocketAddress(const UdpAddress& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(address.port);
  inet_pton(AF_INET, address.host.c_str(), &result.sin_addr);
  return result;
}

}  // namespace

UdpAddress ParseUdpAddress(const std::string& text) {
  const size_t colon = text.rfind(':');
  UdpAddress address;
  in_addr ignored{};
  if (colon != std::string::npos) {
    address.host = text.substr(0, colon);
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, address.port);
    if (error == std::errc() && rest == end &&
        inet_pton(AF_INET, address.host.c_str(), &ignored) == 1)
      return address;
  }
  throw std::invalid_argument("`" + text +
                              "` is no IPv4 address with a port, such as 127.0.0.1:20000");
}

CannelloniPort::CannelloniPort(const UdpAddress& local, const UdpAddress& remote,
                               const Clock& clock)
    : clock_(clock), remote_(remote) {
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const sockaddr_in address = ToSocketAddress(local);
  const int buffer = kReceiveBuffer;
  if (socket_ >= 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  if (socket_ < 0 ||
      bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string why = std::strerror(errno);
    if (socket_ >= 0) close(socket_);
    throw std::runtime_error("CAN by UDP: cannot bind " + local.host + ":" +
                             std::to_string(local.port) + ": " + why);
  }
}

CannelloniPort::~CannelloniPort() { close(socket_); }

std::optional<ReceivedFrame> CannelloniPort::Receive() {
  if (waiting_.empty()) ReadDatagram();
  if (waiting_.empty()) return std::nullopt;
  const ReceivedFrame frame = waiting_.front();
  waiting_.pop_front();
  ++counts_.received;
  return frame;
}

void CannelloniPort::ReadDatagram() {
  const sockaddr_in expected = ToSocketAddress(remote_);
  std::array<uint8_t, kMaxDatagram> bytes;
  for (int i = 0; i < kMaxDatagramsPerReceive && waiting_.empty(); ++i) {
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t length = recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                    reinterpret_cast<sockaddr*>(&sender), &size);
    // ECONNREFUSED tells of an earlier send to a peer that is not there yet.
    if (length < 0 && errno == ECONNREFUSED) continue;
    if (length < 0) return;
    const bool known =
        sender.sin_addr.s_addr == expected.sin_addr.s_addr && sender.sin_port == expected.sin_port;
    const auto datagram =
        known ? DecodeCannelloni({bytes.data(), static_cast<size_t>(length)}) : std::nullopt;
    if (!datagram) {
      ++counts_.malformed;
      continue;
    }
    const int64_t now = clock_.NowMicros();
    for (const CanFrame& frame : datagram->frames) waiting_.push_back({frame, now});
  }
}

void CannelloniPort::Send(std::span<const CanFrame> frames) {
  const sockaddr_in address = ToSocketAddress(remote_);
  while (!frames.empty()) {
    const auto part = frames.first(std::min(frames.size(), kMaxCannelloniFrames));
    frames = frames.subspan(part.size());
    const std::vector<uint8_t> bytes = EncodeCannelloni(sequence_++, part);
    const ssize_t sent = sendto(socket_, bytes.data(), bytes.size(), 0,
                                reinterpret_cast<const sockaddr*>(&address), sizeof address);
    (sent == static_cast<ssize_t>(bytes.size()) ? counts_.sent : counts_.unsent) +=
        static_cast<int64_t>(part.size());
  }
}

}  // namespace hairpin
