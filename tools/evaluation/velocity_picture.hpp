#pragma once

#include <string>

#include "tools/evaluation/velocity_evaluation.hpp"

namespace hairpin {

/// An SVG picture: the dead-reckoned line on the GPS fixes, seen from above, with the figures.
std::string DrawVelocityReport(const VelocityReport& report, const Car& car);

}  // namespace hairpin
