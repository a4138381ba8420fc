#include "daemons/path_tracker/drive_gate.hpp"

#include <cmath>
#include <string>

#include "common/clock.hpp"
#include "common/require.hpp"

namespace hairpin {

void Check(const DriveGateParams& params) {
  constexpr Require require("DriveGate");
  require(params.as_state_deadline > 0.0, "the deadline of AS_STATE must be > 0");
  require(params.pipeline_status_deadline > 0.0, "the deadline of PIPELINE_STATUS must be > 0");
  require(params.max_data_age > 0.0, "max_data_age_s must be > 0");
  require(params.max_path_age >= params.max_data_age, "max_path_age_s must be >= max_data_age_s");
  require(params.stop_deceleration > 0.0, "stop_deceleration_mps2 must be > 0");
  require(params.finish_deceleration > 0.0, "finish_deceleration_mps2 must be > 0");
}

DriveDecision Decide(const DriveGateInput& input, const DriveGateParams& params) {
  if (!input.as_state || !input.as_state->driving) {
    return {DriveAction::kHold, params.stop_deceleration, false};
  }
  const auto fresh = [&](int64_t utime, double deadline) {
    return std::abs(SecondsBetween(utime, input.utime)) <= deadline;  // a time far ahead is a lie
  };
  const bool supervised = fresh(input.as_state->utime, params.as_state_deadline) &&
                          input.pipeline_status && !input.pipeline_status->stop &&
                          fresh(input.pipeline_status->utime, params.pipeline_status_deadline);
  const bool guided = input.path_utime && fresh(*input.path_utime, params.max_path_age);
  if (!supervised || !guided || !input.velocity_valid) {
    return {DriveAction::kStop, params.stop_deceleration, false};
  }
  if (input.as_state->mission_finished) {
    return {DriveAction::kStop, params.finish_deceleration, false};
  }
  return {DriveAction::kDrive, 0.0, fresh(*input.path_utime, params.max_data_age)};
}

}  // namespace hairpin
