#pragma once

#include <functional>
#include <string>

#include "common/errors.hpp"

namespace CLI {
class App;
}

namespace hairpin {

/// main() of a tool or a daemon: parses, works, and returns the exit code: what `work` says, or by
/// what was thrown, its text on stderr, each line after the app's name. Callbacks of subcommands
/// run while parsing, and may throw alike.
int RunProgram(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& work);

/// --config-dir, and HAIRPIN_CONFIG_DIR in the environment; `directory` is the default.
void AddConfigDirOption(CLI::App& app, std::string& directory);

}  // namespace hairpin
