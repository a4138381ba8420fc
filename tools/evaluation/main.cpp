#include "common/program.hpp"
#include "tools/evaluation/commands.hpp"

namespace hairpin {
namespace {

int Main(int argc, char** argv) {
  CLI::App app("Figures from recordings, for people or (--json) for machines", "hairpin-evaluate");
  app.require_subcommand(1);
  AddLidarCommand(app);
  AddMapCommand(app);
  AddPlannerCommand(app);
  AddRunCommand(app);
  AddSlamCommand(app);
  AddTruthCommand(app);
  AddVelocityCommand(app);
  return RunProgram(app, argc, argv, [] { return 0; });  // parsing runs the subcommand
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
