#pragma once

#include <string>

namespace hairpin {

/// Throws std::invalid_argument, "name must be in [min, max], is value", unless it is; NaN is not.
void RequireWithin(const std::string& name, double value, double min, double max);
/// The same for "name must be > 0".
void RequirePositive(const std::string& name, double value);
/// The same for "name must be >= 0".
void RequireNotNegative(const std::string& name, double value);

}  // namespace hairpin
