#pragma once

#include "common/errors.hpp"

namespace hairpin {

/// A recording that cannot be used: "file: frame N: key: reason".
class RecordingError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace hairpin
