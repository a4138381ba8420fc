#include "common/daemon.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "lidar_cone_detector", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::LidarConeDetectorNode(hairpin::LoadLidarConeDetectorParams(config), bus);
      });
}
