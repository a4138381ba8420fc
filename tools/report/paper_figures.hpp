#pragma once

#include <array>

/// What the paper reports, to be beaten; per cent and metres as there.
namespace hairpin::paper {

/// Figure 6a, FSG 2019 Autocross: share of paths by length; the last reached 15 m.
inline constexpr std::array<double, 16> kLengthPercent{
    0.0, 0.0, 0.0, 0.0, 0.0, 1.39, 2.96, 2.53, 2.00, 0.96, 1.74, 3.40, 4.53, 6.27, 8.71, 65.51};
/// Figure 6b, the same run: share of paths that first lie off the track at 0, 1, ... 15 m.
inline constexpr std::array<double, 16> kOutOfTrackPercent{
    0.0, 0.0, 0.0, 0.0, 0.0, 0.44, 1.22, 0.96, 0.35, 0.17, 0.0, 0.44, 0.17, 0.0, 0.35, 0.44};
/// Table I, by the bins of kColourBinEnds.
inline constexpr std::array<double, 5> kColourAccuracy{0.99, 0.99, 1.00, 1.00, 1.00};
/// Table II, at 12 m/s.
inline constexpr double kMapRmse = 0.29;
inline constexpr double kMaxSpeed = 12.0;
/// Section III-C: a false positive that was held for certain is gone within this [s].
inline constexpr double kFalsePositiveLifetime = 0.5;

}  // namespace hairpin::paper
