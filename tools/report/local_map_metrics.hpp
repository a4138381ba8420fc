#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/report/run_log.hpp"

namespace hairpin {

/// Distances from the car by which colours are judged, upper ends [m] [paper IV-A, Table I].
inline constexpr std::array<double, 5> kColourBinEnds{5.0, 7.5, 10.0, 12.5, 15.0};

/// How well the local map knows the colours of blue and yellow cones, by distance from the car.
struct ColourMetrics {
  std::array<int, kColourBinEnds.size()>
      count{};  // certain cones of all local maps that lie at a true cone
  std::array<int, kColourBinEnds.size()> right{};  // most probable class is the true one
  std::array<int, kColourBinEnds.size()>
      unknown{};  // most probable class is unknown, which counts as not right
};
ColourMetrics MeasureColours(const RunLog& log);
nlohmann::json ToJson(const ColourMetrics& metrics);

/// How long each false positive was held for certain: existence from kCertainExistence on, farther
/// than kMatchGate from every true cone, summed over its life [s]. In the order of (epoch, id).
std::vector<double> FalsePositiveLifetimes(const RunLog& log);
nlohmann::json FalsePositiveJson(const std::vector<double>& lifetimes);

/// How far dead reckoning had drifted from the truth at the end of the mapper's longest epoch.
struct Drift {
  double position = 0.0;  // m
  double yaw = 0.0;       // rad, positive: local has turned counter-clockwise against the truth
};
std::optional<Drift> MeasureDrift(const RunLog& log);
nlohmann::json ToJson(const std::optional<Drift>& drift);

}  // namespace hairpin
