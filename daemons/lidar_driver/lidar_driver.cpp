#include "daemons/lidar_driver/lidar_driver.hpp"

#include <utility>

#include "common/clock.hpp"
#include "daemons/lidar_driver/position_packet.hpp"

namespace hairpin {
namespace {

// From one packet's stamp to the next; a longer step is an outage, or a clock newly set.
constexpr double kMaxStep = 0.25;  // s

std::string AddressText(uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8)
    text += std::to_string(address >> shift & 0xffu) + (shift > 0 ? "." : "");
  return text;
}

}  // namespace

LidarDriver::LidarDriver(const LidarDriverParams& params,
                         std::unique_ptr<const PacketDecoder> decoder)
    : sensor_address_(params.sensor_address),
      decoder_(std::move(decoder)),
      clock_(params.clock),
      revolutions_(params.revolution, decoder_->column_period()) {}

LidarDriverResult LidarDriver::Refuse(Refused refused) {
  ++refused_[static_cast<size_t>(refused.reason)];
  revolutions_.CountRefused();
  return {std::nullopt, std::move(refused)};
}

LidarDriverResult LidarDriver::Add(const LidarPacket& packet) {
  if (sensor_address_ && packet.sender && *packet.sender != *sensor_address_)
    return Refuse({Refusal::kSender, "packet from " + AddressText(*packet.sender)});
  if (!decoder_->IsDataSize(packet.payload.size()) &&
      packet.payload.size() == kPositionPacketSize) {
    const auto position = DecodePositionPacket(packet.payload);
    if (!position) return Refuse({Refusal::kTime, "position packet with a time beyond the hour"});
    clock_.Hear(*position);
    return {};
  }
  if (auto refused = decoder_->Decode(packet.payload, decoded_)) return Refuse(std::move(*refused));
  if (!clock_.Advance(decoded_.time_us, packet.receive_utime))
    return Refuse({Refusal::kFrozen, "packet whose time does not advance"});
  if (!revolutions_.Advances(decoded_))
    return Refuse({Refusal::kFrozen, "packet whose azimuth does not advance"});
  ++used_;
  const std::optional<int64_t> utime = clock_.utime();
  if (!utime) return {};
  const double step = last_utime_ ? SecondsBetween(*last_utime_, *utime) : 0.0;
  if (step < 0.0 || step > kMaxStep) revolutions_.Reset();
  last_utime_ = utime;
  return {revolutions_.Add(decoded_, *utime), std::nullopt};
}

}  // namespace hairpin
