#pragma once

#include <string>
#include <vector>

namespace hairpin {

/// The "key=value" of `name` among "name.key=value".
inline std::vector<std::string> OverridesOf(const std::string& name,
                                            const std::vector<std::string>& overrides) {
  std::vector<std::string> own;
  for (const std::string& assignment : overrides) {
    if (assignment.starts_with(name + ".")) own.push_back(assignment.substr(name.size() + 1));
  }
  return own;
}

}  // namespace hairpin
