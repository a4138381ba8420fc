#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/bus.hpp"
#include "common/clock.hpp"
#include "common/map_mode.hpp"
#include "tools/race/stack.hpp"

namespace hairpin {

/// Makes simulated time wait for the stack's answers, so that the outcome of a lap does not depend
/// on how fast the machine is. After each tick it waits for VELOCITY, DRIVE_COMMAND, AS_STATE and
/// PIPELINE_STATUS of that tick, and for LOCAL_MAP, GLOBAL_MAP and TRACK of the newest observations
/// that the map's mode uses. Where sensors are raw, for each scan and its cones, and
/// for GNSS.
///
/// A channel that has not answered within `patience` of wall time counts as silent and is not
/// waited for until it speaks again: a dead daemon costs one such wait, not one a tick.
class Lockstep {
 public:
  /// `patience` [s].
  Lockstep(Transport& transport, SensorLevel level, double patience);

  /// Handles messages until the stack has answered the tick of time `utime`, and `also()` is true:
  /// an answer that comes another way, and is given up in the same manner.
  void Await(int64_t utime, const std::function<bool()>& also);
  /// True if someone is not answering; the run then goes no faster than real time.
  bool AnyoneSilent() const;
  /// Waits missed so far.
  int missed() const { return missed_; }

 private:
  struct Answer {
    int64_t newest = 0;
    bool silent = true;  // until first heard
  };
  bool Answered(int64_t utime) const;
  int64_t Wanted(const std::string& channel, int64_t utime) const;
  void Heard(const std::string& channel, int64_t utime);
  template <class M>
  void Listen(const Channel<M>& channel);

  Transport& transport_;
  double patience_;
  MonotonicClock clock_;
  Bus bus_;
  std::map<std::string, Answer> answers_;
  bool also_silent_ = true;
  std::map<Pipeline, int64_t> observed_;
  int64_t vehicle_utime_ = 0;
  MapMode mode_ = MapMode::kUnknown;
  int missed_ = 0;
};

}  // namespace hairpin
