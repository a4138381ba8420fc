#pragma once

#include <CLI/CLI.hpp>

namespace hairpin {

/// Each declares one subcommand of hairpin-evaluate and what it does once its line has been parsed:
/// figures on stdout, progress on stderr. Running throws ConfigError or RecordingError for input
/// that cannot be used, std::exception where it failed otherwise.
void AddLidarCommand(CLI::App& app);
void AddMapCommand(CLI::App& app);
void AddPlannerCommand(CLI::App& app);
void AddRunCommand(CLI::App& app);
void AddSlamCommand(CLI::App& app);
void AddTruthCommand(CLI::App& app);
void AddVelocityCommand(CLI::App& app);

}  // namespace hairpin
