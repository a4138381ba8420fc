#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/bus.hpp"
#include "common/can/can_port.hpp"
#include "common/clock.hpp"
#include "common/config.hpp"
#include "daemons/can_gateway/can_gateway.hpp"

namespace hairpin {

struct CanGatewayConfig {
  CanGatewayParams gateway;
  std::string interface;  // of SocketCAN; empty: cannelloni
  std::string local;      // addresses of cannelloni
  std::string remote;
};

/// Reads `can_gateway.yaml` and `car.yaml`.
CanGatewayConfig LoadCanGatewayConfig(const Config& config);

/// The port that the config asks for. Throws std::runtime_error where it cannot be opened.
std::unique_ptr<CanPort> OpenCanPort(const CanGatewayConfig& config, const Clock& clock);

/// Reads the CAN bus and publishes IMU, GROUND_SPEED, MOTORS, STEERING and VEHICLE; sends what
/// DRIVE_COMMAND, AS_STATE and PIPELINE_STATUS allow.
class CanGatewayNode {
 public:
  /// `clock` is a monotonic wall clock; it must outlive the node, as `bus` must. Throws as
  /// CanGateway does.
  CanGatewayNode(const CanGatewayParams& params, Bus& bus, std::unique_ptr<CanPort> port,
                 const Clock& clock);
  /// Leaves the actuators neutral, and falls silent.
  ~CanGatewayNode();
  CanGatewayNode(const CanGatewayNode&) = delete;
  CanGatewayNode& operator=(const CanGatewayNode&) = delete;

  /// To be called when the descriptor is readable, and each 10 ms: takes what has arrived, sends
  /// what is due.
  void Poll();
  std::vector<int> descriptors() const;

  const CanGateway& gateway() const { return gateway_; }
  const CanPort& port() const { return *port_; }

 private:
  void Subscribe();
  void Publish(const Measurement& measurement);
  void SendDue();
  void Report();

  Bus& bus_;
  const Clock& clock_;
  std::unique_ptr<CanPort> port_;
  CanGateway gateway_;
  int32_t local_cones_ = 0;
  int32_t global_cones_ = 0;
  int64_t reported_refusals_ = 0;
  int64_t next_report_ = 0;  // wall, us
  std::string reported_emergency_;
};

}  // namespace hairpin
