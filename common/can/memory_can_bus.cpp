#include "common/can/memory_can_bus.hpp"

#include <algorithm>

namespace hairpin {

MemoryCanBus::Port::Port(MemoryCanBus& bus, const Clock& clock) : bus_(bus), clock_(clock) {
  bus_.ports_.push_back(this);
}

MemoryCanBus::Port::~Port() { std::erase(bus_.ports_, this); }

std::optional<ReceivedFrame> MemoryCanBus::Port::Receive() {
  if (waiting_.empty()) return std::nullopt;
  const ReceivedFrame frame{waiting_.front(), clock_.NowMicros()};
  waiting_.pop_front();
  ++counts_.received;
  return frame;
}

void MemoryCanBus::Port::Send(std::span<const CanFrame> frames) {
  const auto count = static_cast<int64_t>(frames.size());
  if (state_ != CanState::kActive) {
    counts_.unsent += count;
    return;
  }
  counts_.sent += count;
  for (Port* port : bus_.ports_) {
    if (port == this) continue;
    port->waiting_.insert(port->waiting_.end(), frames.begin(), frames.end());
    while (port->waiting_.size() > kMaxWaiting) {
      port->waiting_.pop_front();
      ++port->counts_.overflowed;
    }
  }
}

}  // namespace hairpin
