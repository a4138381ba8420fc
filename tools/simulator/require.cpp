#include "tools/simulator/require.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hairpin {
namespace {

void Require(bool holds, const std::string& name, const std::string& relation, double value) {
  if (holds && std::isfinite(value)) return;
  std::ostringstream text;
  text << name << " must be " << relation << ", is " << value;
  throw std::invalid_argument(text.str());
}

}  // namespace

void RequireWithin(const std::string& name, double value, double min, double max) {
  std::ostringstream relation;
  relation << "in [" << min << ", " << max << "]";
  Require(value >= min && value <= max, name, relation.str(), value);
}

void RequirePositive(const std::string& name, double value) {
  Require(value > 0.0, name, "> 0", value);
}

void RequireNotNegative(const std::string& name, double value) {
  Require(value >= 0.0, name, ">= 0", value);
}

}  // namespace hairpin
