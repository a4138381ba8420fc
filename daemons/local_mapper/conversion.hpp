#pragma once

#include <optional>
#include <string_view>

#include "daemons/local_mapper/local_mapper.hpp"
#include "daemons/local_mapper/observation.hpp"
#include "hairpin/cones_t.hpp"
#include "hairpin/local_map_t.hpp"

namespace hairpin {

struct ConvertedSet {
  std::optional<ObservationSet> set;
  std::string_view problem;  // where there is no set
};

/// Checked conversion from the wire. One bad cone or sector spoils the message: a detector that
/// sends it is not to be believed on the rest.
ConvertedSet ToObservationSet(Pipeline pipeline, const cones_t& message);

local_map_t ToMessage(const LocalMapEstimate& estimate);

}  // namespace hairpin
