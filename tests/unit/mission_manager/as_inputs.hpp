#pragma once

#include <functional>

#include "daemons/mission_manager/as_state_machine.hpp"

namespace hairpin {

inline constexpr int64_t kStart = 1'000'000'000;
inline int64_t At(double seconds) { return kStart + static_cast<int64_t>(seconds * 1e6); }

/// All is well, standing.
inline AsInput Good(double seconds) {
  AsInput input;
  input.utime = At(seconds);
  input.mission = vehicle_t::MISSION_AUTOCROSS;
  input.ebs = Ebs::kArmed;
  input.master_switch_on = true;
  input.tractive_system_on = true;
  input.shutdown_circuit_closed = true;
  input.brakes_engaged = true;
  input.brakes_ok = true;
  input.standstill = true;
  return input;
}

/// What is changed of an input.
using Spoil = std::function<void(AsInput&)>;

}  // namespace hairpin
