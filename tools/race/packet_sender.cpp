#include "tools/race/packet_sender.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "daemons/lidar_driver/lidar_driver_node.hpp"

namespace hairpin {

PacketSender::PacketSender(const Config& config)
    : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (socket_ < 0) throw std::runtime_error(std::string("UDP socket: ") + std::strerror(errno));
  for (const std::string& instance : LidarInstances()) {
    const LidarDriverNodeParams params = LoadLidarDriverParams(config, instance);
    ports_["lidar_" + instance] = {params.data_port, params.position_port};
  }
}

PacketSender::~PacketSender() { close(socket_); }

void PacketSender::Send(const std::string& sensor, bool position, std::span<const uint8_t> packet) {
  const Ports& ports = ports_.at(sensor);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(position ? ports.position : ports.data);
  sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&address),
         sizeof address);
}

}  // namespace hairpin
