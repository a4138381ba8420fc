#include "daemons/lidar_driver/lidar_driver_node.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "common/lidar_scan.hpp"

namespace hairpin {
namespace {

constexpr const char* kInput = "packets";
constexpr double kTimeStep = 4e-6;  // s: 16 bits of it hold the slowest head's turn

const Channel<lidar_scan_t>& ChannelOf(const std::string& instance) {
  if (instance == "front") return channels::kLidarFront;
  if (instance == "top") return channels::kLidarTop;
  throw std::invalid_argument("lidar_driver: there is no LiDAR called " + instance);
}

std::string Milliseconds(double seconds) {
  return std::to_string(std::lround(seconds * 1e3)) + " ms";
}

}  // namespace

std::vector<std::string> LidarInstances() { return {"front", "top"}; }

LidarDriverNode::LidarDriverNode(const LidarDriverNodeParams& params, const std::string& instance,
                                 Bus& bus)
    : params_(params),
      bus_(bus),
      channel_(ChannelOf(instance)),
      health_(bus.AddInput(kInput)),
      driver_(params.driver, std::make_unique<VelodyneDecoder>(params.sensor)),
      clock_monitor_(params.clock_window_s) {
  bus_.Subscribe(channels::kImu, [this](const imu_t& message) { OnImu(message.utime); });
}

void LidarDriverNode::OnImu(int64_t utime) {
  if (driver_.utime()) clock_monitor_.Hear(*driver_.utime(), utime);
}

void LidarDriverNode::OnPacket(const LidarPacket& packet) {
  const LidarDriverResult result = driver_.Add(packet);
  if (result.refused) return CountRefused(*result.refused);
  ++health_.received;
  if (result.revolution) Publish(*result.revolution);
}

void LidarDriverNode::CountRefused(const Refused& refused) {
  const auto of_this_kind = driver_.refused()[static_cast<size_t>(refused.reason)];
  if (refused.reason == Refusal::kSender) {
    ++health_.refused;
  } else if (refused.reason == Refusal::kFrozen) {
    ++health_.duplicates;
  } else {
    ++health_.undecodable;
  }
  bus_.WarnOfInput(kInput, "dropped: " + refused.what + " (" + std::string(NameOf(refused.reason)) +
                               ", " + std::to_string(of_this_kind) + " so far)");
}

void LidarDriverNode::Publish(const Revolution& revolution) {
  const double clock_error = clock_monitor_.error().value_or(0.0);
  bus_.AdvanceDataTime(revolution.utime);
  if (std::abs(clock_error) > params_.warn_clock_error_s)
    bus_.WarnOfInput(kInput, "sensor's clock is off the IMU's by " + Milliseconds(clock_error));
  if (std::abs(clock_error) > params_.max_clock_error_s) {
    ++health_.implausible_time;
    return;
  }
  const PacketDecoder& decoder = driver_.decoder();
  lidar_scan_t message{};
  message.utime = revolution.utime;
  message.sensor_model = decoder.model();
  message.time_source = static_cast<int32_t>(driver_.time_source());
  message.clock_error_s = clock_error;
  message.covered_share = revolution.covered_share;
  message.ring_elevation_rad = decoder.ring_elevations();
  message.num_rings = static_cast<int32_t>(message.ring_elevation_rad.size());
  message.azimuth_step_rad = revolution.column_step;
  message.coordinate_step_m = params_.coordinate_step;
  message.time_step_s = kTimeStep;
  PackPoints(revolution.points, message);
  bus_.Publish(channel_, std::move(message));
}

}  // namespace hairpin
