#include "common/daemon.hpp"
#include "daemons/global_mapper/global_mapper_node.hpp"
#include "daemons/global_mapper/least_squares.hpp"

int main(int argc, char** argv) {
  hairpin::KeepFreedMemory();
  return hairpin::RunDaemon(
      "global_mapper", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::GlobalMapperNode(hairpin::LoadGlobalMapperConfig(config), bus);
      });
}
