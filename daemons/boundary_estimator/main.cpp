#include "common/daemon.hpp"
#include "daemons/boundary_estimator/boundary_estimator_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "boundary_estimator", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::BoundaryEstimatorNode(hairpin::LoadBoundaryEstimatorParams(config), bus);
      });
}
