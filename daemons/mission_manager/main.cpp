#include "common/daemon.hpp"
#include "daemons/mission_manager/mission_manager_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "mission_manager", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::MissionManagerNode(hairpin::LoadMissionManagerParams(config), bus);
      });
}
