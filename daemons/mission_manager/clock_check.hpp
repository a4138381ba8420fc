#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hairpin {

/// A sensor that stamps what it measures.
struct ClockedSensor {
  std::string channel;
  double tolerance = 0.0;  // [s], > 0: its clock may be so far from the others'
};

/// Whether the sensors' clocks agree. A measurement is a little late when it arrives, by its way
/// through the computer; the least delay of a while is what its clock is behind by. The median over
/// all sensors is taken for right, so one that runs ahead is named, and not all the others.
class ClockCheck {
 public:
  /// The least delay is taken over `window` to twice that [s]. Throws std::invalid_argument for
  /// values out of bounds.
  ClockCheck(const std::vector<ClockedSensor>& sensors, double window);

  /// A measurement of `utime` has arrived when data time was `now`; of no sensor: ignored.
  void Heard(const std::string& channel, int64_t utime, int64_t now);
  /// What is wrong, a text for each sensor, in the order of their names. Of less than three sensors
  /// none can be said to be the wrong one.
  std::vector<std::string> Problems() const;

 private:
  struct Delay {
    double tolerance;
    int64_t window = -1;  // its number
    double least = 0.0;   // in it [s] ...
    double before = 0.0;  // ... and in the one before
  };
  int64_t window_micros_;
  std::map<std::string, Delay> delays_;
};

}  // namespace hairpin
