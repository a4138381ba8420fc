#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace hairpin {

/// The smallest sample that at least `percent` of them do not exceed (nearest rank); empty for no
/// samples. Throws std::invalid_argument unless 0 < percent <= 100.
std::optional<double> Percentile(std::vector<double> samples, double percent);

/// Square root of the mean square; empty for no samples.
std::optional<double> RootMeanSquare(const std::vector<double>& samples);

/// The number, or null where there is none or it is not finite.
nlohmann::json OrNull(const std::optional<double>& value);

/// {"p50":, "p99":, "max":}, null for no samples.
nlohmann::json PercentilesJson(const std::vector<double>& samples);

}  // namespace hairpin
