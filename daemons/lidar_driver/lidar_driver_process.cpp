#include "daemons/lidar_driver/lidar_driver_process.hpp"

namespace hairpin {
namespace {

// A poll must end, whatever comes: this is 100 ms of a sensor's packets.
constexpr int kMaxPacketsPerPoll = 256;

// "front" of "lidar_driver_front".
std::string InstanceOf(const Bus& bus) { return bus.daemon().substr(bus.daemon().rfind('_') + 1); }

}  // namespace

LidarDriverProcess::LidarDriverProcess(const Config& config, Bus& bus, const std::string& pcap_file,
                                       const Clock& clock)
    : params_(LoadLidarDriverParams(config, InstanceOf(bus))),
      node_(params_, InstanceOf(bus), bus),
      clock_(clock) {
  const std::vector<uint16_t> ports{params_.data_port, params_.position_port};
  if (pcap_file.empty()) {
    for (const uint16_t port : ports)
      sockets_.push_back(std::make_unique<UdpReceiver>(port, params_.receive_buffer_bytes));
    return;
  }
  capture_ = std::make_unique<PcapReader>(pcap_file, ports);
  next_ = capture_->Next();
  if (next_) capture_start_ = next_->receive_utime - clock_.NowMicros();
}

std::vector<int> LidarDriverProcess::descriptors() const {
  std::vector<int> descriptors;
  for (const auto& socket : sockets_) descriptors.push_back(socket->descriptor());
  return descriptors;
}

void LidarDriverProcess::Poll() {
  if (capture_) return PollCapture();
  int64_t overflows = 0;
  for (const auto& socket : sockets_) {
    socket->Receive(kMaxPacketsPerPoll,
                    [this](const LidarPacket& packet) { node_.OnPacket(packet); });
    overflows += socket->overflows();
  }
  node_.OnOverflows(overflows);
}

void LidarDriverProcess::PollCapture() {
  const int64_t now = capture_start_ + clock_.NowMicros();
  for (int i = 0; i < kMaxPacketsPerPoll && next_ && next_->receive_utime <= now; ++i) {
    node_.OnPacket(*next_);
    next_ = capture_->Next();
  }
}

}  // namespace hairpin
