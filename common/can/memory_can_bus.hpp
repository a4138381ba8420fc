#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/clock.hpp"

namespace hairpin {

/// A CAN bus within one process: what one port sends, all others receive, in that order. Nothing
/// is lost but what nobody fetches.
class MemoryCanBus {
 public:
  static constexpr size_t kMaxWaiting = 100'000;

  class Port final : public CanPort {
   public:
    Port(MemoryCanBus& bus, const Clock& clock);
    ~Port() override;
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;

    int descriptor() const override { return -1; }
    std::optional<ReceivedFrame> Receive() override;
    void Send(std::span<const CanFrame> frames) override;
    CanState state() const override { return state_; }
    const CanPortCounts& counts() const override { return counts_; }
    /// As a controller would report it.
    void SetState(CanState state) { state_ = state; }

   private:
    friend class MemoryCanBus;
    MemoryCanBus& bus_;
    const Clock& clock_;
    std::deque<CanFrame> waiting_;
    CanState state_ = CanState::kActive;
    CanPortCounts counts_;
  };

  /// The bus must outlive its ports, and `clock` each of them.
  std::unique_ptr<Port> Attach(const Clock& clock) { return std::make_unique<Port>(*this, clock); }

 private:
  std::vector<Port*> ports_;
};

}  // namespace hairpin
