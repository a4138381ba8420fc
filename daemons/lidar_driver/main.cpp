#include "common/daemon.hpp"
#include "daemons/lidar_driver/lidar_driver_process.hpp"

int main(int argc, char** argv) {
  std::string pcap_file;
  const hairpin::DaemonSpec spec{
      "lidar_driver",
      hairpin::LidarInstances(),
      {{"--pcap", "a capture to be read as if it were the wire, at its own pace", &pcap_file}}};
  const hairpin::MonotonicClock clock;
  return hairpin::RunDaemon(spec, argc, argv,
                            [&](hairpin::Bus& bus, const hairpin::Config& config) {
                              return hairpin::LidarDriverProcess(config, bus, pcap_file, clock);
                            });
}
