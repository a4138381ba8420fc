#include "common/daemon.hpp"
#include "daemons/can_gateway/can_gateway_node.hpp"

int main(int argc, char** argv) {
  const hairpin::MonotonicClock clock;
  return hairpin::RunDaemon(
      "can_gateway", argc, argv, [&clock](hairpin::Bus& bus, const hairpin::Config& config) {
        const hairpin::CanGatewayConfig can = hairpin::LoadCanGatewayConfig(config);
        return hairpin::CanGatewayNode(can.gateway, bus, hairpin::OpenCanPort(can, clock), clock);
      });
}
