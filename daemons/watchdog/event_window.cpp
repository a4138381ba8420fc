#include "daemons/watchdog/event_window.hpp"

#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {

EventWindow::EventWindow(double duration_s, size_t limit) : duration_s_(duration_s), limit_(limit) {
  if (!(duration_s > 0.0)) throw std::invalid_argument("EventWindow: duration_s must be > 0");
  if (limit == 0) throw std::invalid_argument("EventWindow: limit must be > 0");
}

void EventWindow::Add(int64_t utime) {
  events_.push_back(utime);
  if (events_.size() > limit_) events_.pop_front();
}

void EventWindow::RemoveNewest() {
  if (!events_.empty()) events_.pop_back();
}

bool EventWindow::Reached(int64_t now) const {
  return events_.size() == limit_ && Within(events_.front(), now);
}

bool EventWindow::Any(int64_t now) const { return !events_.empty() && Within(events_.back(), now); }

bool EventWindow::Within(int64_t event, int64_t now) const {
  return SecondsBetween(event, now) <= duration_s_;
}

}  // namespace hairpin
