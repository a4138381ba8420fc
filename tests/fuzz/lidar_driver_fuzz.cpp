// What a rotating LiDAR's port may bring. Whatever comes, nothing may crash, throw, or read past a
// packet; and the points that come out are finite, within the range asked for, on rings that exist,
// and fit into the message.
//
// An input is the models' choice (first byte) and packets, each with a kind and a seed (two bytes):
// a good data packet whose bytes are then overwritten from the input, a good position packet
// likewise, or bytes as they come.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "common/lidar_scan.hpp"
#include "daemons/lidar_driver/lidar_driver.hpp"
#include "daemons/lidar_driver/velodyne_decoder.hpp"
#include "tests/support/velodyne_packets.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

class Input {
 public:
  Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  uint8_t Byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  hairpin::Bytes Take(size_t size) {
    size = std::min(size, left_);
    hairpin::Bytes bytes(data_, data_ + size);
    data_ += size;
    left_ -= size;
    return bytes;
  }

 private:
  const uint8_t* data_;
  size_t left_;
};

constexpr double kMaxRange = 120.0;

hairpin::LidarDriver MakeDriver(bool vlp32) {
  const size_t lasers = vlp32 ? 32 : 16;
  hairpin::VelodyneParams sensor{vlp32 ? "VLP-32C" : "VLP-16", {}, 0.5, kMaxRange};
  for (size_t i = 0; i < lasers; ++i) {
    sensor.calibration.elevation.push_back(0.02 * static_cast<double>(i) - 0.3);
    sensor.calibration.azimuth_offset.push_back(i % 2 == 0 ? 0.07 : -0.07);
  }
  const hairpin::LidarDriverParams params{{0.01, 1.0, 0.2}, {2.0, 0.3}, std::nullopt};
  return hairpin::LidarDriver(params, std::make_unique<hairpin::VelodyneDecoder>(sensor));
}

// Overwrites a few bytes, where and with what the input says.
void Damage(hairpin::Bytes& packet, Input& input) {
  for (int edits = input.Byte() % 8; edits > 0; --edits) {
    const size_t at = (size_t{input.Byte()} << 8 | input.Byte()) % packet.size();
    packet[at] = input.Byte();
  }
}

hairpin::Bytes NextPacket(Input& input, hairpin::VelodyneSource& source) {
  const uint8_t kind = input.Byte() % 8;
  if (kind < 4) {
    hairpin::Bytes packet = source.Next();
    Damage(packet, input);
    return packet;
  }
  if (kind == 4) {  // turns far, so that a few bytes make a revolution
    source.azimuth = std::fmod(source.azimuth + 130.0 * input.Byte(), 36000.0);
    source.time_us = (source.time_us + 300u * input.Byte()) % 3'600'000'000u;
    return source.Next();
  }
  if (kind == 5) {
    auto packet = hairpin::VelodynePosition(
        source.time_us, "GPRMC,101723,A,4930.0,N,00834.0,E,000.0,000.0,241126,,,A", 2);
    Damage(packet, input);
    return packet;
  }
  const size_t sizes[] = {1206, 512, size_t{input.Byte()}, 12608};
  return input.Take(sizes[input.Byte() % 4]);
}

void Check(const hairpin::Revolution& revolution, const hairpin::PacketDecoder& decoder) {
  Insist(revolution.covered_share >= 0.0 && revolution.covered_share <= 1.0);
  Insist(std::isfinite(revolution.column_step) && revolution.column_step >= 0.0);
  for (const hairpin::LidarPoint& point : revolution.points) {
    const double range = static_cast<double>(point.position.norm());
    Insist(range >= 0.49 && range <= kMaxRange + 0.01);
    Insist(point.ring < decoder.ring_elevations().size());
    Insist(point.age >= 0.0f && point.age <= 0.262f);
  }
  hairpin::lidar_scan_t message{};
  message.coordinate_step_m = 0.004;
  message.time_step_s = 4e-6;
  message.covered_share = revolution.covered_share;
  message.ring_elevation_rad = decoder.ring_elevations();
  hairpin::PackPoints(revolution.points, message);
  std::vector<hairpin::LidarPoint> again;
  Insist(hairpin::UnpackPoints(message, again).empty() && again.size() == revolution.points.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Input input(data, size);
  const uint8_t choice = input.Byte();
  const bool vlp32 = choice % 2 == 0;
  hairpin::LidarDriver driver = MakeDriver(vlp32);
  hairpin::VelodyneSource source;
  source.product = vlp32 ? 0x28 : 0x22;
  source.mode = choice % 3 == 0 ? 0x39 : 0x37;
  int64_t packets = 0;
  for (; !input.empty() && packets < 500; ++packets) {
    const hairpin::Bytes bytes = NextPacket(input, source);
    // Exactly as large as the packet, so that a read past it is seen.
    const std::unique_ptr<uint8_t[]> exact(new uint8_t[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), exact.get());
    const auto result =
        driver.Add({{exact.get(), bytes.size()}, 1'700'000'000'000'000 + packets, {}});
    if (result.revolution) Check(*result.revolution, driver.decoder());
  }
  int64_t refused = 0;
  for (const int64_t count : driver.refused()) refused += count;
  Insist(driver.used() + refused <= packets);
  return 0;
}
