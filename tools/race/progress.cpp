#include "tools/race/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>

namespace hairpin {
namespace {

constexpr int64_t kTerminalPeriod = 250'000;  // us of wall time
constexpr int64_t kLogPeriod = 5'000'000;
constexpr size_t kMaxReason = 90;  // what fits beside it on a line

const char* NameOfState(int state) {
  switch (state) {
    case as_state_t::STATE_OFF:
      return "AS Off";
    case as_state_t::STATE_READY:
      return "AS Ready";
    case as_state_t::STATE_DRIVING:
      return "AS Driving";
    case as_state_t::STATE_EMERGENCY:
      return "AS Emergency";
    case as_state_t::STATE_FINISHED:
      return "AS Finished";
    case as_state_t::STATE_MANUAL:
      return "Manual";
    default:
      return "starting";
  }
}

}  // namespace

Progress::Progress(Transport& transport)
    : bus_(transport, "progress", 1), terminal_(isatty(STDERR_FILENO) != 0) {
  bus_.Subscribe(channels::kTruth, [this](const truth_t& message) { truth_ = message; });
  bus_.Subscribe(channels::kAsState, [this](const as_state_t& message) { as_state_ = message; });
  bus_.Subscribe(channels::kLocalMap,
                 [this](const local_map_t& message) { num_cones_ = message.num_cones; });
  bus_.Subscribe(channels::kPipelineStatus, [this](const pipeline_status_t& message) {
    mode_ = static_cast<MapMode>(message.map_mode);
  });
}

void Progress::Show(int64_t utime) {
  if (start_utime_ == 0) start_utime_ = utime;
  now_utime_ = utime;
  const int64_t wall = clock_.NowMicros();
  const int64_t elapsed = wall - shown_wall_;
  if (shown_wall_ != 0 && elapsed < (terminal_ ? kTerminalPeriod : kLogPeriod)) return;
  const double factor =
      shown_wall_ == 0 ? 0.0
                       : static_cast<double>(utime - shown_utime_) / static_cast<double>(elapsed);
  shown_wall_ = wall;
  shown_utime_ = utime;
  std::cerr << (terminal_ ? "\r\033[K" : "") << Line(factor) << (terminal_ ? "" : "\n")
            << std::flush;
}

std::string Progress::Line(double real_time_factor) const {
  const bool says_why =
      as_state_.state == as_state_t::STATE_OFF || as_state_.state == as_state_t::STATE_EMERGENCY;
  if (says_why) {
    char start[40];
    std::snprintf(start, sizeof start, "%6.1f s  %-12s ", SecondsBetween(start_utime_, now_utime_),
                  NameOfState(as_state_.state));
    return start + as_state_.reason.substr(0, kMaxReason);
  }
  char line[160];
  std::snprintf(line, sizeof line,
                "%6.1f s  %-12s lap %d  %6.1f m  %4.1f m/s  %-16s %3d cones  x%.1f",
                SecondsBetween(start_utime_, now_utime_), NameOfState(as_state_.state),
                as_state_.lap, truth_.distance_m, std::hypot(truth_.vx_mps, truth_.vy_mps),
                NameOf(mode_), num_cones_, real_time_factor);
  return line;
}

void Progress::End() {
  if (terminal_ && shown_wall_ != 0) std::cerr << '\n';
}

}  // namespace hairpin
