#include "common/daemon.hpp"
#include "daemons/local_mapper/local_mapper_node.hpp"

int main(int argc, char** argv) {
  return hairpin::RunDaemon(
      "local_mapper", argc, argv, [](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::LocalMapperNode(hairpin::LoadLocalMapperParams(config), bus);
      });
}
