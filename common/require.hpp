#pragma once

#include <stdexcept>
#include <string>

namespace hairpin {

/// What parameters must fulfil: throws std::invalid_argument "OWNER: RULE" where one does not hold.
class Require {
 public:
  explicit constexpr Require(const char* owner) : owner_(owner) {}
  /// `rule` names the parameter, the relation and the bound.
  void operator()(bool holds, const std::string& rule) const {
    if (!holds) throw std::invalid_argument(std::string(owner_) + ": " + rule);
  }

 private:
  const char* owner_;
};

}  // namespace hairpin
