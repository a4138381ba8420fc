#pragma once

#include <stdexcept>
#include <string>

namespace hairpin {

/// Throws std::invalid_argument with `rule` (parameter, relation, bound) unless `holds`.
inline void Require(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument("local_mapper: " + rule);
}

}  // namespace hairpin
