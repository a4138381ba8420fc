#include "daemons/lidar_driver/udp_receiver.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kMaxDatagram = 65536;

int64_t Micros(const timespec& time) {
  return int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

std::runtime_error SystemError(uint16_t port, const std::string& what) {
  return std::runtime_error("UDP port " + std::to_string(port) + ": " + what + ": " +
                            std::strerror(errno));
}

}  // namespace

std::optional<uint32_t> ParseIpv4(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

UdpReceiver::UdpReceiver(uint16_t port, int buffer_bytes)
    : port_(port),
      socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      buffer_(kMaxDatagram) {
  if (socket_ < 0) throw SystemError(port, "no socket");
  const int on = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  const bool ready =
      setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0 &&
      setsockopt(socket_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) == 0 &&
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes) == 0 &&
      bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (ready) return;
  const std::runtime_error error = SystemError(port, "cannot listen");
  close(socket_);
  throw error;
}

UdpReceiver::~UdpReceiver() { close(socket_); }

void UdpReceiver::ReadControl(msghdr& message, LidarPacket& packet) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(part), sizeof time);
      packet.receive_utime = Micros(time);
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&overflows_, CMSG_DATA(part), sizeof overflows_);
    }
  }
}

void UdpReceiver::Receive(int max_packets, const std::function<void(const LidarPacket&)>& handler) {
  for (int i = 0; i < max_packets; ++i) {
    sockaddr_in sender{};
    iovec data{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) char control[256];
    msghdr message{};
    message.msg_name = &sender;
    message.msg_namelen = sizeof sender;
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t size = recvmsg(socket_, &message, 0);
    if (size < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return;
      throw SystemError(port_, "receiving failed");
    }
    LidarPacket packet{
        {buffer_.data(), static_cast<size_t>(size)}, 0, ntohl(sender.sin_addr.s_addr)};
    ReadControl(message, packet);
    handler(packet);
  }
}

}  // namespace hairpin
