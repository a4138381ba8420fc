#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemons/mission_manager/mission_manager.hpp"

namespace hairpin {

/// Tells people on stderr why the car does not drive: at once where it loses a state, and every ten
/// seconds, from five on, while it is Off. Silent where all goes well.
class MissionConsole {
 public:
  /// `daemon`: what the lines begin with.
  explicit MissionConsole(std::string daemon) : daemon_(std::move(daemon)) {}

  /// To be asked for each report; `now` is data time.
  bool IsDue(const MissionReport& report, int64_t now);
  /// `problems`: all of the software's.
  void Tell(const MissionReport& report, const std::vector<std::string>& problems) const;

 private:
  std::string daemon_;
  AsState state_ = AsState::kOff;
  int64_t next_utime_ = 0;
};

const char* NameOf(AsState state);

}  // namespace hairpin
