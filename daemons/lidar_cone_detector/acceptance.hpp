#pragma once

#include "daemons/lidar_cone_detector/expected_returns.hpp"

namespace hairpin {

struct AcceptanceParams {
  int min_returns = 0;     // above the ground's band
  double min_share = 0.0;  // of the expected number: hidden, dark and dropped returns
  double max_share = 0.0;
  double spare_returns = 0.0;  // on top of max_share: counts are small far off
  double missing_top = 0.0;    // below the highest beam that should have met the cone [m]
  double excess_top = 0.0;     // above the cone's own height: noise, and error of the ground [m]
  double max_residual = 0.0;   // of the fit [m]
};

/// What was measured of a candidate, heights above the ground [m].
struct ConeEvidence {
  int returns = 0;  // above the ground's band
  float top = 0.0f;
  float residual = 0.0f;  // of the fit
  float height = 0.0f;    // that such a cone has
  ExpectedReturns expected;
};

enum class Verdict { kCone, kTooFew, kTooMany, kTooLow, kTooHigh, kNoCone, kPartOfMore };

/// Is it one? By the number of returns against the expected one, the height that they reach against
/// the highest beam that meets a cone there and against a cone's own height (posts, people, ends of
/// barriers), and how well a cone's surface fits.
Verdict Judge(const ConeEvidence& evidence, const AcceptanceParams& params);

}  // namespace hairpin
