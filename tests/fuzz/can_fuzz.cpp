// The border at which bytes from the network become CAN frames, and frames become measurements.
// Whatever comes, nothing may crash, throw or allocate by a count that stands in the bytes; what is
// decoded encodes to the same bytes again, and what is believed is finite.
//
// An input is a datagram of cannelloni. Its frames reach the gateway as they are, and once more
// with their checksum set right and an identifier of the car, so that the checks behind are tried.

#include <cmath>
#include <cstdlib>

#include "common/can/cannelloni.hpp"
#include "daemons/can_gateway/frame_decoder.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

void Check(const hairpin::Measurement& measurement) {
  if (const auto* motors = std::get_if<hairpin::MotorsSample>(&measurement)) {
    for (const double speed : motors->speed) Insist(std::abs(speed) <= 300.0);
    for (const double torque : motors->torque) Insist(std::abs(torque) <= 510.0);
  }
  if (const auto* imu = std::get_if<hairpin::ImuSample>(&measurement)) {
    for (const double value : imu->acceleration) Insist(std::abs(value) <= 60.0);
    for (const double value : imu->angular_rate) Insist(std::abs(value) <= 9.0);
  }
  if (const auto* steering = std::get_if<hairpin::SteeringSample>(&measurement))
    Insist(std::abs(steering->angle) <= 1.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto datagram = hairpin::DecodeCannelloni({data, size});
  if (!datagram) return 0;
  if (datagram->frames.size() <= hairpin::kMaxCannelloniFrames) {
    const auto again = hairpin::EncodeCannelloni(datagram->sequence, datagram->frames);
    Insist(again.size() == size && std::equal(again.begin(), again.end(), data));
  }
  static const std::vector<uint32_t> ids = hairpin::IdsOfTheCar();
  hairpin::FrameDecoder decoder(0.2);
  int64_t wall = 1;
  for (hairpin::CanFrame frame : datagram->frames) {
    if (const auto measurement = decoder.Take({frame, ++wall})) Check(*measurement);
    frame.id = ids[frame.id % ids.size()];
    if (frame.length > 0) frame.data[frame.length - 1u] = hairpin::ProtectionOf(frame);
    if (const auto measurement = decoder.Take({frame, ++wall})) Check(*measurement);
  }
  Insist(decoder.refusals().size() <= 200);
  return 0;
}
