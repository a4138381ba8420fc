#include "daemons/path_tracker/drive_gate.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr int64_t kNow = 1'000'000'000;
constexpr DriveGateParams kParams{.as_state_deadline = 0.2,
                                  .pipeline_status_deadline = 0.1,
                                  .max_data_age = 0.3,
                                  .max_path_age = 0.5,
                                  .stop_deceleration = 7.0,
                                  .finish_deceleration = 4.0};

DriveGateInput Good() {
  return {kNow, true, AsStateInput{kNow - 50'000, true, false},
          PipelineStatusInput{kNow - 20'000, false, 12.0}, kNow - 150'000};
}

TEST(DriveGate, DrivesWhereAllIsWell) {
  const DriveDecision decision = Decide(Good(), kParams);
  EXPECT_EQ(decision.action, DriveAction::kDrive);
  EXPECT_TRUE(decision.may_accelerate);
}

TEST(DriveGate, HoldsUnlessTheStateIsDriving) {
  DriveGateInput input = Good();
  input.as_state->driving = false;
  EXPECT_EQ(Decide(input, kParams).action, DriveAction::kHold);
  input.as_state.reset();
  EXPECT_EQ(Decide(input, kParams).action, DriveAction::kHold);
}

TEST(DriveGate, StopsForEachCauseAlone) {
  const std::vector<std::pair<const char*, std::function<void(DriveGateInput&)>>> causes{
      {"velocity invalid", [](auto& input) { input.velocity_valid = false; }},
      {"mission_manager silent", [](auto& input) { input.as_state->utime = kNow - 201'000; }},
      {"watchdog silent", [](auto& input) { input.pipeline_status->utime = kNow - 101'000; }},
      {"watchdog from the future",
       [](auto& input) { input.pipeline_status->utime = kNow + 101'000; }},
      {"watchdog never heard", [](auto& input) { input.pipeline_status.reset(); }},
      {"stop asked for", [](auto& input) { input.pipeline_status->stop = true; }},
      {"no path", [](auto& input) { input.path_utime.reset(); }},
      {"path too old", [](auto& input) { input.path_utime = kNow - 501'000; }}};
  for (const auto& [name, spoil] : causes) {
    DriveGateInput input = Good();
    spoil(input);
    const DriveDecision decision = Decide(input, kParams);
    EXPECT_EQ(decision.action, DriveAction::kStop) << name;
    EXPECT_EQ(decision.deceleration, 7.0) << name;
    EXPECT_FALSE(decision.may_accelerate) << name;
    // The harder stop wins over the comfortable one.
    input.as_state->mission_finished = true;
    EXPECT_EQ(Decide(input, kParams).deceleration, 7.0) << name;
  }
}

TEST(DriveGate, StopsComfortablyAfterTheFinish) {
  DriveGateInput input = Good();
  input.as_state->mission_finished = true;
  EXPECT_EQ(Decide(input, kParams).action, DriveAction::kStop);
  EXPECT_EQ(Decide(input, kParams).deceleration, 4.0);
}

TEST(DriveGate, DoesNotAccelerateOnAPathOlderThan300Milliseconds) {
  DriveGateInput input = Good();
  input.path_utime = kNow - 300'000;
  EXPECT_TRUE(Decide(input, kParams).may_accelerate);
  input.path_utime = kNow - 301'000;
  EXPECT_EQ(Decide(input, kParams).action, DriveAction::kDrive);
  EXPECT_FALSE(Decide(input, kParams).may_accelerate);
}

TEST(DriveGate, RefusesWrongParameters) {
  const auto wrong = [](auto spoil) {
    DriveGateParams params = kParams;
    spoil(params);
    EXPECT_THROW(Check(params), std::invalid_argument);
  };
  wrong([](DriveGateParams& p) { p.as_state_deadline = 0.0; });
  wrong([](DriveGateParams& p) { p.pipeline_status_deadline = 0.0; });
  wrong([](DriveGateParams& p) { p.max_data_age = 0.0; });
  wrong([](DriveGateParams& p) { p.max_path_age = 0.2; });
  wrong([](DriveGateParams& p) { p.stop_deceleration = 0.0; });
  wrong([](DriveGateParams& p) { p.finish_deceleration = 0.0; });
}

}  // namespace
}  // namespace hairpin
