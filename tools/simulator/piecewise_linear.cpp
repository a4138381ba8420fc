#include "tools/simulator/piecewise_linear.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace hairpin {

PiecewiseLinear::PiecewiseLinear(const std::string& name, std::vector<double> knots,
                                 std::vector<double> values)
    : knots_(std::move(knots)), values_(std::move(values)) {
  if (knots_.empty() || knots_.size() != values_.size()) {
    throw std::invalid_argument(name + " must have as many values as knots, and at least one");
  }
  if (std::adjacent_find(knots_.begin(), knots_.end(), std::greater_equal<>()) != knots_.end()) {
    throw std::invalid_argument(name + " must have rising knots");
  }
}

double PiecewiseLinear::operator()(double x) const {
  const auto above = std::upper_bound(knots_.begin(), knots_.end(), x);
  if (above == knots_.begin()) return values_.front();
  if (above == knots_.end()) return values_.back();
  const auto i = static_cast<size_t>(above - knots_.begin());
  const double share = (x - knots_[i - 1]) / (knots_[i] - knots_[i - 1]);
  return values_[i - 1] + share * (values_[i] - values_[i - 1]);
}

}  // namespace hairpin
