#include "daemons/lidar_cone_detector/acceptance.hpp"

namespace hairpin {

Verdict Judge(const ConeEvidence& evidence, const AcceptanceParams& params) {
  const auto returns = static_cast<double>(evidence.returns);
  if (evidence.returns < params.min_returns) return Verdict::kTooFew;
  if (returns < params.min_share * static_cast<double>(evidence.expected.most))
    return Verdict::kTooFew;
  if (returns >
      params.max_share * static_cast<double>(evidence.expected.all) + params.spare_returns)
    return Verdict::kTooMany;
  if (evidence.top < evidence.expected.top - static_cast<float>(params.missing_top))
    return Verdict::kTooLow;
  if (evidence.top > evidence.height + static_cast<float>(params.excess_top))
    return Verdict::kTooHigh;
  if (evidence.residual > static_cast<float>(params.max_residual)) return Verdict::kNoCone;
  return Verdict::kCone;
}

}  // namespace hairpin
