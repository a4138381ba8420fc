#include "tools/report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hairpin {

std::optional<double> Percentile(std::vector<double> samples, double percent) {
  if (!(percent > 0.0 && percent <= 100.0))
    throw std::invalid_argument("percent must be in (0, 100]");
  if (samples.empty()) return std::nullopt;
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(samples.size()));
  const auto nth = samples.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(samples.begin(), nth, samples.end());
  return *nth;
}

std::optional<double> RootMeanSquare(const std::vector<double>& samples) {
  if (samples.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double sample : samples) sum += sample * sample;
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

nlohmann::json OrNull(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

nlohmann::json PercentilesJson(const std::vector<double>& samples) {
  return {{"p50", OrNull(Percentile(samples, 50.0))},
          {"p99", OrNull(Percentile(samples, 99.0))},
          {"max", OrNull(Percentile(samples, 100.0))}};
}

}  // namespace hairpin
