#include "common/can/deadman.hpp"

#include <stdexcept>

namespace hairpin {

void Check(const DeadmanLimits& limits) {
  const bool ordered = limits.hold_after > 0.0 && limits.neutral_after >= limits.hold_after &&
                       limits.silent_after >= limits.neutral_after && limits.silent_after <= 1.0;
  if (!ordered) {
    throw std::invalid_argument(
        "deadman: need 0 < hold_after <= neutral_after <= silent_after <= 1 s");
  }
}

DeadmanStage StageAt(double age, const DeadmanLimits& limits) {
  if (age > limits.silent_after) return DeadmanStage::kSilent;
  if (age > limits.neutral_after) return DeadmanStage::kNeutral;
  return age > limits.hold_after ? DeadmanStage::kHeld : DeadmanStage::kFresh;
}

}  // namespace hairpin
