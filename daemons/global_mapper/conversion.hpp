#pragma once

#include <optional>
#include <string_view>

#include "daemons/global_mapper/map_estimate.hpp"
#include "hairpin/global_map_t.hpp"
#include "hairpin/local_map_t.hpp"

namespace hairpin {

inline constexpr size_t kMaxGlobalMapCones = 750;

struct ConvertedMap {
  std::optional<LocalMapInput> map;
  std::string_view problem;  // where there is no map
};

/// Checked conversion from the wire. One bad cone spoils the message: a mapper that sends it is not
/// to be believed on the rest. `max_cones`: more is nonsense.
ConvertedMap ToLocalMapInput(const local_map_t& message, size_t max_cones);

/// At most kMaxGlobalMapCones cones go into a message, so that it stays under 60 kB.
global_map_t ToMessage(const GlobalMapEstimate& estimate);

}  // namespace hairpin
