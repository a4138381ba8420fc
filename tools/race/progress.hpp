#pragma once

#include <cstdint>
#include <string>

#include "common/bus.hpp"
#include "common/clock.hpp"
#include "common/map_mode.hpp"

namespace hairpin {

/// The live line on stderr: rewritten in place four times a second on a terminal, a line each five
/// seconds elsewhere.
class Progress {
 public:
  explicit Progress(Transport& transport);
  /// Shows the state if it is time to.
  void Show(int64_t utime);
  /// Leaves the last line standing.
  void End();

 private:
  std::string Line(double real_time_factor) const;

  Bus bus_;
  MonotonicClock clock_;
  bool terminal_;
  int64_t shown_wall_ = 0;
  int64_t shown_utime_ = 0;
  int64_t start_utime_ = 0;
  truth_t truth_{};
  as_state_t as_state_{};
  MapMode mode_ = MapMode::kUnknown;
  int num_cones_ = 0;
  int64_t now_utime_ = 0;
};

}  // namespace hairpin
