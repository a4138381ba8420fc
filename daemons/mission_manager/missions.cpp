#include "daemons/mission_manager/missions.hpp"

#include "hairpin/vehicle_t.hpp"

namespace hairpin {

std::string MissionProblem(int32_t mission) {
  const char* name = nullptr;
  switch (mission) {
    case vehicle_t::MISSION_AUTOCROSS:
    case vehicle_t::MISSION_TRACKDRIVE:
    case vehicle_t::MISSION_ACCELERATION:
    case vehicle_t::MISSION_BRAKE_TEST:
      return {};
    case vehicle_t::MISSION_SKIDPAD:
      name = "skidpad";
      break;
    case vehicle_t::MISSION_INSPECTION:
      name = "inspection";
      break;
    case vehicle_t::MISSION_MANUAL:
      return {};  // the driver drives it
    default:
      return "no mission is selected";
  }
  return std::string("mission ") + name + " cannot be driven yet";
}

}  // namespace hairpin
