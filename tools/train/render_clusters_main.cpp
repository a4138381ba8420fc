// hairpin-render-clusters: simulated intensity images of cones, to train the colour net with.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "common/program.hpp"
#include "daemons/lidar_cone_detector/intensity_image.hpp"
#include "tools/simulator/simulator_params.hpp"
#include "tools/train/render_clusters.hpp"

namespace hairpin {
namespace {

struct Arguments {
  std::string out;
  std::string config_dir;
  uint64_t seed = 1;
  int scans = 100;
};

constexpr int kMinReturns = 2;
constexpr float kSteps = 128.0f;  // of a pixel's byte, for 1.0

// A record: label byte (0 unknown, 1 blue, 2 yellow), range in dm, returns up to 255, image bytes.
void Write(const LabelledCone& cone, std::ostream& out) {
  const bool known = cone.colour == ConeColour::kBlue || cone.colour == ConeColour::kYellow;
  const auto byte = [](float value) {
    return static_cast<char>(static_cast<uint8_t>(std::clamp(std::round(value), 0.0f, 255.0f)));
  };
  out.put(known ? static_cast<char>(cone.colour) : '\0');
  out.put(byte(10.0f * cone.returns.axis.norm()));
  out.put(byte(static_cast<float>(cone.returns.x.size())));
  for (const float value : RenderIntensity(cone.returns, 1.0f)) out.put(byte(kSteps * value));
}

void Render(const Arguments& arguments) {
  const Config config = Config::Load(arguments.config_dir, "simulator");
  const Car car = LoadCar(config);
  const SimulatorParams params = LoadSimulatorParams(config);
  std::ofstream out(arguments.out, std::ios::binary);
  for (int scan = 0; scan < arguments.scans; ++scan) {
    const uint64_t seed = arguments.seed * 1'000'000 + static_cast<uint64_t>(scan);
    for (const LabelledCone& cone : RenderClusters(params.lidars, car, seed)) {
      if (cone.returns.x.size() >= kMinReturns) Write(cone, out);
    }
    if (scan % 100 == 0) std::cerr << "scan " << scan << " of " << arguments.scans << '\n';
  }
  out.close();
  if (!out) throw std::runtime_error(arguments.out + ": cannot write");
}

int Main(int argc, char** argv) {
  CLI::App app("Renders simulated cones as the colour net sees them.", "hairpin-render-clusters");
  Arguments arguments;
  app.add_option("--out", arguments.out, "file to write")->required();
  app.add_option("--config-dir", arguments.config_dir, "folder of the .yaml files")->required();
  app.add_option("--seed", arguments.seed, "of everything random")->capture_default_str();
  app.add_option("--scans", arguments.scans, "random worlds, some 30 cones each")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  return RunProgram(app, argc, argv, [&arguments] {
    Render(arguments);
    return 0;
  });
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
