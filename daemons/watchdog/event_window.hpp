#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace hairpin {

/// Counts events within a sliding window of data time; remembers no more than it needs to know that
/// `limit` is reached.
class EventWindow {
 public:
  /// Throws std::invalid_argument unless duration_s > 0 and limit > 0.
  EventWindow(double duration_s, size_t limit);

  void Add(int64_t utime);
  /// Takes back the newest event.
  void RemoveNewest();
  /// True if `limit` events or more happened within `duration_s` up to `now`.
  bool Reached(int64_t now) const;
  /// True if any did.
  bool Any(int64_t now) const;

 private:
  bool Within(int64_t event, int64_t now) const;

  double duration_s_;
  size_t limit_;
  std::deque<int64_t> events_;  // the newest `limit`, oldest first
};

}  // namespace hairpin
