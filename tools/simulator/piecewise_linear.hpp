#pragma once

#include <string>
#include <vector>

namespace hairpin {

/// A function of range given by knots, straight between them and constant beyond the first and the
/// last.
class PiecewiseLinear {
 public:
  /// Throws std::invalid_argument, with `name`, unless there are as many knots as values, at least
  /// one, and they rise.
  PiecewiseLinear(const std::string& name, std::vector<double> knots, std::vector<double> values);
  /// A constant.
  explicit PiecewiseLinear(double value) : PiecewiseLinear("constant", {0.0}, {value}) {}

  double operator()(double x) const;
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> knots_;
  std::vector<double> values_;
};

}  // namespace hairpin
