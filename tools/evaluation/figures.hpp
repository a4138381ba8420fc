#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hairpin {

/// Prints to stdout: one JSON object for machines, or a line per key for people, the parts of a
/// part under "part.key".
void PrintFigures(const nlohmann::json& figures, bool as_json);

/// Writes a picture or table. Throws std::runtime_error where it cannot be written.
void WriteFile(const std::string& file, const std::string& text);

}  // namespace hairpin
