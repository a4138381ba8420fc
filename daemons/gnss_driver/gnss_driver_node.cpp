#include "daemons/gnss_driver/gnss_driver_node.hpp"

#include "common/geometry.hpp"
#include "daemons/gnss_driver/serial_port.hpp"

namespace hairpin {
namespace {

constexpr const char* kInput = "serial";

GnssErrorModel LoadErrors(const Config& config) {
  return {.single_m = config.Number("single_m", {0.1, 100.0}),
          .differential_m = config.Number("differential_m", {0.1, 100.0}),
          .float_m = config.Number("float_m", {0.01, 100.0}),
          .rtk_m = config.Number("rtk_m", {0.001, 10.0}),
          .vertical_factor = config.Number("vertical_factor", {0.1, 10.0}),
          .velocity_mps = config.Number("velocity_mps", {0.001, 10.0}),
          .heading_rad = config.Number("heading_rad", {1e-4, 1.0})};
}

bool HasPosition(const GnssFix& fix) {
  return fix.type != FixType::kNone && fix.type != FixType::kUnknown;
}

}  // namespace

GnssDriverParams LoadGnssDriverParams(const Config& config) {
  GnssDriverParams params;
  params.port = config.Text("port");
  params.baud_rate = config.Integer("baud_rate", 9600, 921600);
  const Config origin = config.Section("origin");
  params.origin_is_first_fix = origin.Flag("is_first_fix");
  params.origin = {origin.Number("latitude_deg", {-90.0, 90.0}),
                   origin.Number("longitude_deg", {-180.0, 180.0}),
                   origin.Number("height_m", {-500.0, 9000.0})};
  params.antenna_baseline_yaw = config.Number("antenna_baseline_yaw_rad", {-3.15, 3.15});
  params.errors = LoadErrors(config.Section("errors"));
  config.Finish();
  if (!SerialPort::IsBaudRate(params.baud_rate))
    throw ConfigError("gnss_driver.yaml: baud_rate: " + std::to_string(params.baud_rate) +
                      " is none that a serial port has");
  return params;
}

gnss_t ToMessage(const GnssFix& fix, const LocalEnu* plane, double antenna_baseline_yaw) {
  const bool is_placed = HasPosition(fix) && plane != nullptr;
  const Eigen::Vector3d position = is_placed ? plane->ToEnu(fix.position) : Eigen::Vector3d::Zero();
  gnss_t message{};
  message.utime = fix.utime;
  message.fix = fix.has_velocity ? static_cast<int32_t>(fix.type) : gnss_t::FIX_NONE;
  for (int i = 0; i < 3; ++i) {
    message.position_enu_m[i] = position[i];
    message.position_sigma_m[i] = fix.position_sigma[i];
    message.velocity_enu_mps[i] = fix.velocity[i];
    message.velocity_sigma_mps[i] = fix.velocity_sigma[i];
  }
  message.heading_valid = fix.heading.has_value();
  message.heading_rad = fix.heading ? WrapAngle(*fix.heading - antenna_baseline_yaw) : 0.0;
  message.heading_sigma_rad = fix.heading_sigma;
  return message;
}

GnssDriverNode::GnssDriverNode(const GnssDriverParams& params, Bus& bus)
    : params_(params), bus_(bus), health_(bus.AddInput(kInput)), decoder_(params.errors) {
  if (!params.origin_is_first_fix) plane_.emplace(params.origin);
}

void GnssDriverNode::OnBytes(Bytes bytes) {
  for (const GnssFix& fix : decoder_.Add(bytes)) Publish(fix);
  CountBad();
}

void GnssDriverNode::Publish(const GnssFix& fix) {
  if (HasPosition(fix) && !plane_) plane_.emplace(fix.position);
  const gnss_t message = ToMessage(fix, plane_ ? &*plane_ : nullptr, params_.antenna_baseline_yaw);
  ++health_.received;
  bus_.Publish(channels::kGnss, message);
  bus_.AdvanceDataTime(message.utime);
}

void GnssDriverNode::CountBad() {
  for (const auto& [why, count] : decoder_.bad()) {
    int64_t& reported = reported_[why];
    if (reported == count) continue;
    const bool is_time = why == GnssDecoder::kTimeDoesNotIncrease;
    (is_time ? health_.implausible_time : health_.undecodable) += count - reported;
    reported = count;
    bus_.WarnOfInput(kInput, why + " (" + std::to_string(count) + " so far)");
  }
}

}  // namespace hairpin
