#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/can/can_frame.hpp"

namespace hairpin {

struct ReceivedFrame {
  CanFrame frame;
  int64_t arrival_micros = 0;  // of the monotonic clock, from the kernel's time stamp where it has
};

enum class CanState { kActive, kBusOff, kDown };

struct CanPortCounts {
  int64_t received = 0;
  int64_t sent = 0;
  int64_t unsent = 0;        // refused by the kernel or by the state of the bus; never queued here
  int64_t overflowed = 0;    // lost because the kernel's queue was full
  int64_t malformed = 0;     // datagrams or frames that are none
  int64_t error_frames = 0;  // of the controller
  int64_t bus_offs = 0;
};

/// A connection to a CAN bus. Neither call waits. What cannot be sent at once is dropped and
/// counted: an old command is worse than none.
class CanPort {
 public:
  virtual ~CanPort() = default;
  /// To wait on for reading; -1 if there is none.
  virtual int descriptor() const = 0;
  /// The next data frame, empty if there is none. Error frames change the state and are not
  /// returned.
  virtual std::optional<ReceivedFrame> Receive() = 0;
  /// Sends what the kernel takes at once, in this order; nothing while the bus is not active.
  virtual void Send(std::span<const CanFrame> frames) = 0;
  virtual CanState state() const = 0;
  virtual const CanPortCounts& counts() const = 0;
};

}  // namespace hairpin
