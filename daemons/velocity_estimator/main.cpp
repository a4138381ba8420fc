#include "common/daemon.hpp"
#include "daemons/velocity_estimator/velocity_estimator_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "velocity_estimator", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::VelocityEstimatorNode(hairpin::LoadVelocityEstimatorParams(config), bus);
      });
}
