#pragma once

#include <stdexcept>
#include <string>

namespace hairpin {

/// Throws std::invalid_argument with `rule` (parameter, relation, bound) unless `holds`.
inline void RequireGlobalMap(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument("global_mapper: " + rule);
}

}  // namespace hairpin
