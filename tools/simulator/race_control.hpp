#pragma once

#include <cstdint>
#include <optional>

#include "common/car.hpp"
#include "hairpin/vehicle_t.hpp"
#include "tools/simulator/actuators.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

struct RaceControlParams {
  int32_t mission = vehicle_t::MISSION_AUTOCROSS;
  double go_after_ready_s = 0.0;         // 5 s at the earliest, by the rules
  double brakes_engaged_pressure = 0.0;  // 0 to 1, from which on the brakes count as engaged
  double res_stop_speed_mps = 0.0;       // at which RES Stop is pressed; 0: never
};

/// The people around the car: mission selected and switches on before the run, RES Go some time
/// after AS Ready, in a brake test RES Stop.
class RaceControl {
 public:
  /// Throws std::invalid_argument for values that cannot be.
  RaceControl(const RaceControlParams& params, const Car& car);

  /// What VEHICLE reports at `utime`, with the state of the actuators and the car.
  vehicle_t Vehicle(int64_t utime, const Actuators& actuators, const VehicleState& state);
  /// Whether somebody presses RES Stop now: in the brake test, once the car is fast enough.
  bool PressesStop(const VehicleState& state) const;

 private:
  RaceControlParams params_;
  Car car_;
  std::optional<int64_t> ready_since_;
  bool go_ = false;
};

}  // namespace hairpin
