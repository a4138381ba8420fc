#pragma once

#include <CLI/CLI.hpp>

namespace hairpin {

/// Each declares one subcommand of hairpin-evaluate and what it does once its line has been parsed:
/// figures on stdout, progress on stderr. Running throws ConfigError or RecordingError for input
/// that cannot be used, std::exception where it failed otherwise.
void AddPlannerCommand(CLI::App& app);

}  // namespace hairpin
