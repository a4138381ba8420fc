#include <iostream>

#include "common/daemon.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

int Fail(const std::exception& error, int code) {
  std::cerr << "hairpin-evaluate: " << error.what() << '\n';
  return code;
}

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
  try {
    app.parse(argc, argv);  // runs the subcommand
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  } catch (const ConfigError& error) {
    return Fail(error, kExitConfig);
  } catch (const RecordingError& error) {
    return Fail(error, kExitConfig);
  } catch (const std::exception& error) {
    return Fail(error, kExitFailure);
  }
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
