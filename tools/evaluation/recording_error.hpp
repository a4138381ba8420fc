#pragma once

#include <stdexcept>

namespace hairpin {

/// A recording that cannot be used: "file: frame N: key: reason".
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hairpin
