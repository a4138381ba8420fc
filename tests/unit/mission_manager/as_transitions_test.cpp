// The transitions of the rules one by one, and all that there are.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/unit/mission_manager/as_inputs.hpp"

namespace hairpin {
namespace {

// What the car is like before, and what changes.
struct Transition {
  const char* name;
  AsState from, to;
  Spoil change;
};

AsStatus In(AsState state) {
  AsStatus status;
  status.state = state;
  status.mission = vehicle_t::MISSION_AUTOCROSS;
  if (state == AsState::kManual) status.mission = vehicle_t::MISSION_MANUAL;
  status.ready_utime = kStart;
  status.go_was_released = true;
  return status;
}

// In which a state stays what it is.
AsInput HomeOf(AsState state) {
  AsInput input = Good(20.0);
  switch (state) {
    case AsState::kOff:
      input.master_switch_on = input.tractive_system_on = false;
      input.ebs = Ebs::kUnavailable;
      break;
    case AsState::kDriving:
      input.brakes_engaged = input.standstill = false;
      break;
    case AsState::kManual:
      input.mission = vehicle_t::MISSION_MANUAL;
      input.master_switch_on = input.brakes_engaged = input.standstill = false;
      input.ebs = Ebs::kUnavailable;
      break;
    case AsState::kFinished:
    case AsState::kEmergency:
      input.ebs = Ebs::kActivated;
      input.mission_finished = true;
      input.shutdown_circuit_closed = input.tractive_system_on = false;
      break;
    case AsState::kReady:
      break;
  }
  return input;
}

class RulesTransition : public testing::TestWithParam<Transition> {};

TEST_P(RulesTransition, IsTaken) {
  const Transition& test = GetParam();
  AsInput input = HomeOf(test.from);
  EXPECT_EQ(NextAsStatus(In(test.from), input, 5.0).state, test.from) << "before";
  test.change(input);
  const AsStatus after = NextAsStatus(In(test.from), input, 5.0);
  EXPECT_EQ(after.state, test.to);
  EXPECT_FALSE(after.reason.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, RulesTransition,
    testing::Values(
        Transition{"OffToReady", AsState::kOff, AsState::kReady,
                   [](AsInput& i) { i = HomeOf(AsState::kReady); }},
        Transition{"OffToManual", AsState::kOff, AsState::kManual,
                   [](AsInput& i) {
                     i.mission = vehicle_t::MISSION_MANUAL;
                     i.tractive_system_on = true;
                   }},
        Transition{"OffToEmergency", AsState::kOff, AsState::kEmergency,
                   [](AsInput& i) { i.ebs = Ebs::kActivated; }},
        Transition{"ManualToOffWithoutTractiveSystem", AsState::kManual, AsState::kOff,
                   [](AsInput& i) { i.tractive_system_on = false; }},
        Transition{"ManualToOffByTheMasterSwitch", AsState::kManual, AsState::kOff,
                   [](AsInput& i) { i.master_switch_on = true; }},
        Transition{"ManualToOffByAnotherMission", AsState::kManual, AsState::kOff,
                   [](AsInput& i) { i = HomeOf(AsState::kReady); }},
        Transition{"ManualToOffWithTheEbsArmed", AsState::kManual, AsState::kOff,
                   [](AsInput& i) { i.ebs = Ebs::kArmed; }},
        Transition{"ManualToEmergency", AsState::kManual, AsState::kEmergency,
                   [](AsInput& i) { i.ebs = Ebs::kActivated; }},
        Transition{"ManualIsTheDriversWhateverTheResSays", AsState::kManual, AsState::kManual,
                   [](AsInput& i) { i.res_stop = true; }},
        Transition{"ReadyToDriving", AsState::kReady, AsState::kDriving,
                   [](AsInput& i) { i.res_go = true; }},
        Transition{"ReadyToOffByTheMasterSwitch", AsState::kReady, AsState::kOff,
                   [](AsInput& i) { i.master_switch_on = false; }},
        Transition{"ReadyToOffWithoutBrakes", AsState::kReady, AsState::kOff,
                   [](AsInput& i) { i.brakes_engaged = false; }},
        Transition{"ReadyToEmergencyByTheEbs", AsState::kReady, AsState::kEmergency,
                   [](AsInput& i) { i.ebs = Ebs::kActivated; }},
        Transition{"ReadyToEmergencyByTheRes", AsState::kReady, AsState::kEmergency,
                   [](AsInput& i) { i.res_stop = true; }},
        Transition{"ReadyToEmergencyByTheCircuit", AsState::kReady, AsState::kEmergency,
                   [](AsInput& i) { i.shutdown_circuit_closed = false; }},
        Transition{"DrivingToFinishedByStanding", AsState::kDriving, AsState::kFinished,
                   [](AsInput& i) { i.mission_finished = i.standstill = true; }},
        Transition{"DrivingToFinishedByTheEbs", AsState::kDriving, AsState::kFinished,
                   [](AsInput& i) { i = HomeOf(AsState::kFinished); }},
        Transition{"DrivingToEmergencyByTheEbs", AsState::kDriving, AsState::kEmergency,
                   [](AsInput& i) { i.ebs = Ebs::kActivated; }},
        Transition{"DrivingToEmergencyByTheEbsThoughTheMissionIsFinished", AsState::kDriving,
                   AsState::kEmergency,
                   [](AsInput& i) {
                     i.ebs = Ebs::kActivated;
                     i.mission_finished = true;
                   }},
        Transition{"DrivingToEmergencyByTheEbsThoughTheCarStands", AsState::kDriving,
                   AsState::kEmergency,
                   [](AsInput& i) {
                     i.ebs = Ebs::kActivated;
                     i.standstill = true;
                   }},
        Transition{"DrivingToEmergencyByTheRes", AsState::kDriving, AsState::kEmergency,
                   [](AsInput& i) {
                     i = HomeOf(AsState::kFinished);
                     i.res_stop = true;
                   }},
        Transition{"DrivingToEmergencyByTheCircuit", AsState::kDriving, AsState::kEmergency,
                   [](AsInput& i) { i.shutdown_circuit_closed = false; }},
        Transition{"DrivingToOffByTheMasterSwitch", AsState::kDriving, AsState::kOff,
                   [](AsInput& i) { i.master_switch_on = false; }},
        Transition{"DrivingToOffByAnotherMission", AsState::kDriving, AsState::kOff,
                   [](AsInput& i) { i.mission = vehicle_t::MISSION_TRACKDRIVE; }},
        Transition{"FinishedToEmergencyByTheRes", AsState::kFinished, AsState::kEmergency,
                   [](AsInput& i) { i.res_stop = true; }},
        Transition{"FinishedToOffOnceTheCarIsReleased", AsState::kFinished, AsState::kOff,
                   [](AsInput& i) {
                     i.master_switch_on = false;
                     i.ebs = Ebs::kUnavailable;
                   }},
        Transition{"FinishedStaysWhileTheEbsHolds", AsState::kFinished, AsState::kFinished,
                   [](AsInput& i) { i.master_switch_on = false; }},
        Transition{"FinishedStaysWhileTheMasterSwitchIsOn", AsState::kFinished, AsState::kFinished,
                   [](AsInput& i) { i.ebs = Ebs::kUnavailable; }},
        Transition{"EmergencyStaysThoughTheCarIsReleased", AsState::kEmergency, AsState::kEmergency,
                   [](AsInput& i) {
                     i.master_switch_on = false;
                     i.ebs = Ebs::kUnavailable;
                   }},
        Transition{"EmergencyStaysThoughAllIsWell", AsState::kEmergency, AsState::kEmergency,
                   [](AsInput& i) { i = HomeOf(AsState::kReady); }}),
    [](const auto& instance) { return std::string(instance.param.name); });

// Every input there is: each switch, each state of the EBS, three missions.
std::vector<AsInput> AllInputs() {
  constexpr unsigned kSwitches = 11;
  constexpr int32_t kMissions[] = {vehicle_t::MISSION_AUTOCROSS, vehicle_t::MISSION_TRACKDRIVE,
                                   vehicle_t::MISSION_MANUAL};
  std::vector<AsInput> inputs;
  for (unsigned bits = 0; bits < 1u << kSwitches; ++bits) {
    const auto on = [bits](unsigned i) { return (bits >> i & 1u) != 0; };
    AsInput input;
    input.mission_problem = on(0) ? "unknown" : "";
    input.system_problem = on(1) ? "late" : "";
    input.master_switch_on = on(2);
    input.tractive_system_on = on(3);
    input.shutdown_circuit_closed = on(4);
    input.brakes_engaged = on(5);
    input.brakes_ok = on(6);
    input.res_go = on(7);
    input.res_stop = on(8);
    input.mission_finished = on(9);
    input.standstill = on(10);
    for (const Ebs ebs : {Ebs::kUnknown, Ebs::kUnavailable, Ebs::kArmed, Ebs::kActivated}) {
      for (const int32_t mission : kMissions) {
        input.ebs = ebs;
        input.mission = mission;
        inputs.push_back(input);
      }
    }
  }
  return inputs;
}

// All of a status that decides what may follow, with the time since Ready in whole seconds.
using Place = std::tuple<AsState, int32_t, int, bool>;

Place PlaceOf(const AsStatus& status, int64_t now) {
  const bool ready = status.state == AsState::kReady;
  const bool on = ready || status.state == AsState::kDriving;
  const int seconds = static_cast<int>((now - status.ready_utime) / 1'000'000);
  return {status.state, on ? status.mission : 0, ready ? std::min(seconds, 6) : 0,
          ready && status.go_was_released};
}

// From Off, with every input each second: no place is left out that any sequence of inputs reaches.
TEST(AsStateMachine, HasNoWayToDrivingThatSkipsReadyAndNoneOutOfEmergency) {
  std::vector<AsInput> inputs = AllInputs();
  ASSERT_EQ(inputs.size(), 2048u * 4u * 3u);
  std::map<Place, AsStatus> seen;
  std::deque<std::pair<Place, AsStatus>> waiting{{PlaceOf({}, kStart), {}}};
  seen.insert(waiting.front());
  std::set<std::pair<AsState, AsState>> taken;
  while (!waiting.empty()) {
    const auto [place, before] = waiting.front();
    waiting.pop_front();
    // A status entered s seconds before now, for all that matters.
    AsStatus status = before;
    const int64_t now = kStart + 1'000'000'000;
    status.ready_utime = now - std::get<2>(place) * 1'000'000;
    for (AsInput& input : inputs) {
      input.utime = now + 1'000'000;
      const AsStatus after = NextAsStatus(status, input, 5.0);
      taken.emplace(status.state, after.state);
      if (after.state == AsState::kDriving && status.state != AsState::kDriving) {
        ASSERT_EQ(status.state, AsState::kReady);
        ASSERT_GE(input.utime - status.ready_utime, 5'000'000);
        ASSERT_TRUE(status.go_was_released && input.res_go);
        ASSERT_EQ(input.mission, status.mission);
      }
      const Place next = PlaceOf(after, input.utime);
      if (seen.emplace(next, after).second) waiting.emplace_back(next, after);
    }
  }
  using enum AsState;
  const std::set<std::pair<AsState, AsState>> expected{{kOff, kOff},
                                                       {kOff, kReady},
                                                       {kOff, kManual},
                                                       {kOff, kEmergency},
                                                       {kReady, kReady},
                                                       {kReady, kOff},
                                                       {kReady, kDriving},
                                                       {kReady, kEmergency},
                                                       {kDriving, kDriving},
                                                       {kDriving, kOff},
                                                       {kDriving, kFinished},
                                                       {kDriving, kEmergency},
                                                       {kManual, kManual},
                                                       {kManual, kOff},
                                                       {kManual, kEmergency},
                                                       {kFinished, kFinished},
                                                       {kFinished, kEmergency},
                                                       {kFinished, kOff},
                                                       {kEmergency, kEmergency}};
  EXPECT_EQ(taken, expected);
  EXPECT_GT(seen.size(), 25u);
}

}  // namespace
}  // namespace hairpin
