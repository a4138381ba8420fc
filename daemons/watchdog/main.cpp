#include "common/daemon.hpp"
#include "daemons/watchdog/watchdog_node.hpp"

int main(int argc, char** argv) {
  const hairpin::MonotonicClock clock;
  return hairpin::RunDaemon(
      "watchdog", argc, argv, [&clock](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::WatchdogNode(hairpin::LoadWatchdogParams(config), bus, clock);
      });
}
