#include "common/program.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>
#include <string>

namespace hairpin {

int RunProgram(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& work) {
  const auto fail = [&app](const std::exception& error, int code) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);)
      std::cerr << app.get_name() << ": " << line << '\n';
    return code;
  };
  try {
    app.parse(argc, argv);
    return work();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  } catch (const UsageError& error) {
    return fail(error, kExitUsage);
  } catch (const InputError& error) {
    return fail(error, kExitConfig);
  } catch (const std::exception& error) {
    return fail(error, kExitFailure);
  }
}

void AddConfigDirOption(CLI::App& app, std::string& directory) {
  app.add_option("--config-dir", directory, "folder of the .yaml files")
      ->envname("HAIRPIN_CONFIG_DIR")
      ->capture_default_str();
}

}  // namespace hairpin
