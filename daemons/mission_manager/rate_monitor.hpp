#pragma once

#include <cstdint>
#include <deque>
#include <string>

namespace hairpin {

struct RateMonitorParams {
  double window = 0.0;     // look back so far [s], > 0
  double min_share = 0.0;  // of the nominal rate that is enough, 0 to 1
};

/// Whether a channel has run at its rate for a while, in data time.
class RateMonitor {
 public:
  /// `rate` nominal [Hz], `deadline` the longest gap [s], from the channel table.
  /// Throws std::invalid_argument for parameters out of their bounds.
  RateMonitor(std::string channel, double rate, double deadline, const RateMonitorParams& params);

  /// A message has arrived when data time was `now`.
  void Heard(int64_t now);
  /// Empty if messages came at `min_share` of the rate over the whole window, and the last one
  /// within the deadline; else what is wrong, for people.
  std::string Problem(int64_t now) const;
  bool heard() const { return !arrivals_.empty(); }

 private:
  std::string channel_;
  double rate_;
  double deadline_;
  RateMonitorParams params_;
  int64_t since_ = 0;             // of the present run without a gap
  std::deque<int64_t> arrivals_;  // within the window; not all of a flood
};

}  // namespace hairpin
