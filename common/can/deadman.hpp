#pragma once

namespace hairpin {

/// What becomes of a command that grows old. Numbered as in AS_STATUS of hairpin.dbc.
enum class DeadmanStage {
  kFresh = 0,
  kHeld = 1,     // the last command goes on
  kNeutral = 2,  // no torque, brakes
  kSilent = 3,   // the heartbeat to the shutdown circuit ceases
};

/// Ages above which the next stage holds [s].
struct DeadmanLimits {
  double hold_after = 0.0;
  double neutral_after = 0.0;
  double silent_after = 0.0;
};

/// Throws std::invalid_argument unless 0 < hold_after <= neutral_after <= silent_after <= 1 s.
void Check(const DeadmanLimits& limits);

/// Stage of a command of age `age` [s] [FAULTS, the CAN deadman].
DeadmanStage StageAt(double age, const DeadmanLimits& limits);

}  // namespace hairpin
