#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "common/can/can_port.hpp"
#include "common/clock.hpp"

namespace hairpin {

/// A CAN interface of Linux. The kernel passes only the identifiers asked for, exactly and as
/// standard data frames, and all error frames; it stamps what arrives.
///
/// Bus-off and an interface that is down are states in which nothing is sent. When the controller
/// is back (`restart-ms`, or by hand) the socket is made anew, so that nothing of before is left in
/// it; the send buffer holds little more than one cycle of commands in the first place.
class SocketCanPort final : public CanPort {
 public:
  /// `clock` is monotonic and must outlive the port. Throws std::runtime_error where the kernel has
  /// no CAN or no such interface.
  SocketCanPort(const std::string& interface, const std::vector<uint32_t>& ids, const Clock& clock);
  ~SocketCanPort() override;
  SocketCanPort(const SocketCanPort&) = delete;
  SocketCanPort& operator=(const SocketCanPort&) = delete;

  int descriptor() const override { return socket_; }
  std::optional<ReceivedFrame> Receive() override;
  void Send(std::span<const CanFrame> frames) override;
  CanState state() const override { return state_; }
  const CanPortCounts& counts() const override { return counts_; }

 private:
  void Open();
  void Close();
  void Reopen();
  void OnReadError(int error);
  void OnErrorFrame(const CanFrame& frame);
  bool ReadBatch();
  size_t SendBatch(std::span<const CanFrame> frames);

  std::string interface_;
  std::vector<uint32_t> ids_;
  const Clock& clock_;
  int socket_ = -1;
  CanState state_ = CanState::kActive;
  uint32_t kernel_drops_ = 0;  // as of the socket's own counter
  int64_t next_open_micros_ = 0;
  std::deque<ReceivedFrame> waiting_;  // data frames of one batch
  CanPortCounts counts_;
};

}  // namespace hairpin
