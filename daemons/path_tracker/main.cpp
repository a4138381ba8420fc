#include "common/daemon.hpp"
#include "daemons/path_tracker/path_tracker_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "path_tracker", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::PathTrackerNode(hairpin::LoadPathTrackerParams(config), bus);
      });
}
