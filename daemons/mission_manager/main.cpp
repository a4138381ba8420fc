#include "common/daemon.hpp"
#include "daemons/mission_manager/host.hpp"
#include "daemons/mission_manager/mission_manager_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "mission_manager", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        const hairpin::MissionManagerParams params = hairpin::LoadMissionManagerParams(config);
        return hairpin::MissionManagerNode(params, bus,
                                           hairpin::ThisHost(params.startup.log_folder, bus.url()));
      });
}
