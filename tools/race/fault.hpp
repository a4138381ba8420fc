#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/errors.hpp"

namespace hairpin {

/// A fault text that cannot be understood; says what would be.
class FaultError : public UsageError {
 public:
  using UsageError::UsageError;
};

/// "fusion off at 10 s", "local_mapper off at 12.5 s for 2 s": a source (a pipeline, a sensor or a
/// daemon) that falls silent at a time after Go, for a while or for good.
struct Fault {
  std::string source;
  double start = 0.0;              // s after Go
  std::optional<double> duration;  // s; empty: for good

  bool ActiveAt(double seconds_since_go) const;
};

/// Throws FaultError with the reason where `text` is no fault, or its source is none of `sources`.
Fault ParseFault(const std::string& text, const std::vector<std::string>& sources);

}  // namespace hairpin
