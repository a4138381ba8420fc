#include "daemons/mission_manager/as_state_machine.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/unit/mission_manager/as_inputs.hpp"

namespace hairpin {
namespace {

// In state Driving at 6 s.
AsStateMachine Driving() {
  AsStateMachine machine(5.0);
  machine.Update(Good(0.0));
  AsInput go = Good(6.0);
  go.res_go = true;
  EXPECT_EQ(machine.Update(go), AsState::kDriving);
  return machine;
}

AsInput Moving(double seconds) {
  AsInput input = Good(seconds);
  input.brakes_engaged = false;
  input.standstill = false;
  return input;
}

struct Case {
  const char* name;
  Spoil spoil;
  AsState off, ready, driving, stopping, finished;  // where it leads from each
};

TEST(AsStateMachine, FollowsTheTruthTableOfTheRules) {
  using enum AsState;
  const std::vector<Case> cases{
      {"nothing", [](AsInput&) {}, kReady, kReady, kDriving, kFinished, kFinished},
      {"no mission", [](AsInput& i) { i.mission_problem = std::string("none"); }, kOff, kOff, kOff,
       kFinished, kFinished},
      {"master switch off", [](AsInput& i) { i.master_switch_on = false; }, kOff, kOff, kOff,
       kFinished, kFinished},
      {"brakes not ok", [](AsInput& i) { i.brakes_ok = false; }, kOff, kOff, kOff, kFinished,
       kFinished},
      {"tractive system off", [](AsInput& i) { i.tractive_system_on = false; }, kOff, kOff, kOff,
       kFinished, kFinished},
      {"brakes not engaged", [](AsInput& i) { i.brakes_engaged = false; }, kOff, kOff, kDriving,
       kFinished, kFinished},
      {"software not ready", [](AsInput& i) { i.system_problem = std::string("late"); }, kOff, kOff,
       kDriving, kFinished, kFinished},
      {"EBS unavailable", [](AsInput& i) { i.ebs = Ebs::kUnavailable; }, kOff, kOff, kOff,
       kFinished, kFinished},
      {"another mission", [](AsInput& i) { i.mission = vehicle_t::MISSION_TRACKDRIVE; }, kReady,
       kOff, kOff, kFinished, kFinished},
      {"EBS activated", [](AsInput& i) { i.ebs = Ebs::kActivated; }, kEmergency, kEmergency,
       kEmergency, kFinished, kFinished},
      {"circuit open", [](AsInput& i) { i.shutdown_circuit_closed = false; }, kOff, kEmergency,
       kEmergency, kFinished, kFinished},
      {"RES stop", [](AsInput& i) { i.res_stop = true; }, kOff, kEmergency, kEmergency, kEmergency,
       kEmergency},
      {"EBS activated and RES stop",
       [](AsInput& i) {
         i.ebs = Ebs::kActivated;
         i.res_stop = true;
       },
       kEmergency, kEmergency, kEmergency, kEmergency, kEmergency}};
  for (const Case& test : cases) {
    AsInput input = Good(0.0);
    test.spoil(input);
    EXPECT_EQ(AsStateMachine(5.0).Update(input), test.off) << test.name << " in Off";

    AsStateMachine ready(5.0);
    ready.Update(Good(0.0));
    input = Good(1.0);
    test.spoil(input);
    EXPECT_EQ(ready.Update(input), test.ready) << test.name << " in Ready";

    AsStateMachine driving = Driving();
    input = Good(7.0);
    test.spoil(input);
    EXPECT_EQ(driving.Update(input), test.driving) << test.name << " in Driving";
    EXPECT_FALSE(driving.reason().empty());

    AsStateMachine stopping = Driving();
    input = Good(7.0);
    input.mission_finished = true;
    test.spoil(input);
    EXPECT_EQ(stopping.Update(input), test.stopping) << test.name << " standing after the mission";

    AsStateMachine finished = Driving();
    input = Good(7.0);
    input.mission_finished = true;
    finished.Update(input);
    EXPECT_EQ(finished.state(), kFinished);
    input.utime = At(8.0);
    test.spoil(input);
    EXPECT_EQ(finished.Update(input), test.finished) << test.name << " in Finished";
  }
}

TEST(AsStateMachine, AcceptsGoAtTheEarliestFiveSecondsAfterReady) {
  AsStateMachine machine(5.0);
  machine.Update(Good(0.0));
  AsInput early = Good(4.99);
  early.res_go = true;
  EXPECT_EQ(machine.Update(early), AsState::kReady);
  machine.Update(Good(5.5));  // released: what was pressed early does not count later
  EXPECT_EQ(machine.state(), AsState::kReady);
  AsInput go = Good(6.0);
  go.res_go = true;
  EXPECT_EQ(machine.Update(go), AsState::kDriving);
}

TEST(AsStateMachine, CountsTheFiveSecondsAnewAfterReadyWasLost) {
  AsStateMachine machine(5.0);
  machine.Update(Good(0.0));
  AsInput lost = Good(4.0);
  lost.system_problem = std::string("VELOCITY is stale");
  EXPECT_EQ(machine.Update(lost), AsState::kOff);
  EXPECT_EQ(machine.reason(), "VELOCITY is stale");
  machine.Update(Good(4.5));
  AsInput go = Good(6.0);
  go.res_go = true;
  EXPECT_EQ(machine.Update(go), AsState::kReady);
  go.utime = At(9.5);
  EXPECT_EQ(machine.Update(go), AsState::kDriving);
}

TEST(AsStateMachine, DoesNotTakeASignalThatWasOnBeforeReadyForGo) {
  AsStateMachine machine(5.0);
  for (double t = 0.0; t < 8.0; t += 0.05) {
    AsInput stuck = Good(t);
    stuck.res_go = true;
    EXPECT_EQ(machine.Update(stuck), AsState::kReady);
  }
  EXPECT_EQ(machine.reason(), "Go must be released first");
  machine.Update(Good(8.0));
  AsInput go = Good(8.05);
  go.res_go = true;
  EXPECT_EQ(machine.Update(go), AsState::kDriving);
}

TEST(AsStateMachine, EmergencyIsFinal) {
  AsStateMachine machine = Driving();
  AsInput stop = Moving(7.0);
  stop.res_stop = true;
  EXPECT_EQ(machine.Update(stop), AsState::kEmergency);
  EXPECT_EQ(machine.reason(), "stopped by the RES");
  AsInput done = Good(20.0);
  done.mission_finished = true;
  EXPECT_EQ(machine.Update(done), AsState::kEmergency);
}

TEST(AsStateMachine, StaysDrivingAfterTheFinishUntilTheCarStands) {
  AsStateMachine machine = Driving();
  AsInput input = Moving(7.0);
  input.mission_finished = true;
  EXPECT_EQ(machine.Update(input), AsState::kDriving);
  EXPECT_EQ(machine.reason(), "mission finished, stopping");
  input.utime = At(10.0);
  input.standstill = true;
  EXPECT_EQ(machine.Update(input), AsState::kFinished);
}

TEST(AsStateMachine, TheEbsBeforeTheCarStandsIsAnEmergencyEvenAfterTheFinish) {
  AsStateMachine machine = Driving();
  AsInput input = Moving(7.0);
  input.mission_finished = true;
  input.ebs = Ebs::kActivated;
  EXPECT_EQ(machine.Update(input), AsState::kEmergency);
}

TEST(AsStateMachine, RefusesANegativeDelay) {
  EXPECT_THROW(AsStateMachine(-1.0), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
