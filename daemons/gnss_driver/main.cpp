#include "common/daemon.hpp"
#include "daemons/gnss_driver/gnss_driver_process.hpp"

int main(int argc, char** argv) {
  const hairpin::MonotonicClock clock;
  return hairpin::RunDaemon(
      "gnss_driver", argc, argv, [&clock](hairpin::Bus& bus, const hairpin::Config& config) {
        return hairpin::GnssDriverProcess(hairpin::LoadGnssDriverParams(config), bus, clock);
      });
}
