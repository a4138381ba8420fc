#include "daemons/mission_manager/mission_console.hpp"

#include <iostream>
#include <utility>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr double kPatience = 5.0;  // s
constexpr double kPeriod = 10.0;

}  // namespace

const char* NameOf(AsState state) {
  switch (state) {
    case AsState::kOff:
      return "AS Off";
    case AsState::kReady:
      return "AS Ready";
    case AsState::kDriving:
      return "AS Driving";
    case AsState::kEmergency:
      return "AS Emergency";
    case AsState::kFinished:
      return "AS Finished";
    case AsState::kManual:
      return "Manual";
  }
  return "unknown";
}

bool MissionConsole::IsDue(const MissionReport& report, int64_t now) {
  const AsState before = std::exchange(state_, report.state);
  const bool off = report.state == AsState::kOff;
  if (next_utime_ == 0 || !off) next_utime_ = AddSeconds(now, kPatience);
  if (before != report.state) return off || report.state == AsState::kEmergency;
  if (!off || now < next_utime_) return false;
  next_utime_ = AddSeconds(now, kPeriod);
  return true;
}

void MissionConsole::Tell(const MissionReport& report,
                          const std::vector<std::string>& problems) const {
  std::cerr << daemon_ << ": " << NameOf(report.state) << ": " << report.reason;
  for (const std::string& problem : problems) {
    if (report.state == AsState::kOff && problem != report.reason) std::cerr << "; " << problem;
  }
  std::cerr << std::endl;
}

}  // namespace hairpin
