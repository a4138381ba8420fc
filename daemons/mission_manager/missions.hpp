#pragma once

#include <cstdint>
#include <string>

namespace hairpin {

/// Why a mission (numbered as in vehicle_t) cannot be driven by this software; empty: it can, or it
/// is the driver's.
std::string MissionProblem(int32_t mission);

}  // namespace hairpin
