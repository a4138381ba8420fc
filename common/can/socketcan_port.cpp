#include "common/can/socketcan_port.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace hairpin {
namespace {

static_assert(CanFrame::kExtended == CAN_EFF_FLAG && CanFrame::kRemote == CAN_RTR_FLAG &&
              CanFrame::kError == CAN_ERR_FLAG);

constexpr size_t kBatch = 32;  // frames read or sent with one call
constexpr int kReceiveBuffer = 1 << 20;
// The kernel doubles it and counts about 750 bytes a frame: a cycle of commands and the data
// logger's frames.
constexpr int kSendBuffer = 5'000;
constexpr int64_t kReopenPeriod = 100'000;    // us
constexpr int64_t kMaxQueueTime = 1'000'000;  // us; a time stamp older than that is a clock's jump

template <class T>
bool SetOption(int socket, int level, int option, const T& value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

int64_t RealtimeMicros() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000;
}

struct Ancillary {
  int64_t age_micros = 0;  // since the kernel took the frame
  std::optional<uint32_t> drops;
};

Ancillary ReadAncillary(msghdr& message, int64_t realtime_micros) {
  Ancillary result;
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      const int64_t micros = int64_t{stamp.tv_sec} * 1'000'000 + stamp.tv_nsec / 1'000;
      const int64_t age = realtime_micros - micros;
      result.age_micros = age >= 0 && age < kMaxQueueTime ? age : 0;
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(part), sizeof drops);
      result.drops = drops;
    }
  }
  return result;
}

CanFrame ToFrame(const can_frame& raw) {
  CanFrame frame{raw.can_id, std::min<uint8_t>(raw.len, 8), {}};
  std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

}  // namespace

SocketCanPort::SocketCanPort(const std::string& interface, const std::vector<uint32_t>& ids,
                             const Clock& clock)
    : interface_(interface), ids_(ids), clock_(clock) {
  Open();
}

SocketCanPort::~SocketCanPort() { Close(); }

void SocketCanPort::Open() {
  const auto fail = [this](const std::string& what) {
    const std::string why = std::strerror(errno);
    Close();
    throw std::runtime_error("CAN interface " + interface_ + ": " + what + ": " + why);
  };
  socket_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (socket_ < 0) fail("this kernel has no CAN");
  std::vector<can_filter> filters;
  for (const uint32_t id : ids_)
    filters.push_back({id, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
  const auto size = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), size) != 0)
    fail("filters refused");
  const can_err_mask_t errors = CAN_ERR_MASK;
  if (!SetOption(socket_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors)) fail("no error frames");
  if (!SetOption(socket_, SOL_SOCKET, SO_TIMESTAMPNS, 1)) fail("no time stamps");
  if (!SetOption(socket_, SOL_SOCKET, SO_RXQ_OVFL, 1)) fail("no count of losses");
  // Above net.core.rmem_max where the process may; the kernel's limit elsewhere.
  if (!SetOption(socket_, SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBuffer))
    SetOption(socket_, SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
  SetOption(socket_, SOL_SOCKET, SO_SNDBUF, kSendBuffer);
  ifreq request{};
  interface_.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(socket_, SIOCGIFINDEX, &request) != 0) fail("no such interface");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (ioctl(socket_, SIOCGIFFLAGS, &request) != 0) fail("no flags");
  const bool up = (request.ifr_flags & IFF_UP) != 0;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fail("cannot bind");
  state_ = up ? CanState::kActive : CanState::kDown;
  kernel_drops_ = 0;
}

void SocketCanPort::Close() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

void SocketCanPort::Reopen() {
  const int64_t now = clock_.NowMicros();
  if (now < next_open_micros_) return;
  next_open_micros_ = now + kReopenPeriod;
  Close();
  try {
    Open();
  } catch (const std::runtime_error&) {
    state_ = CanState::kDown;  // the interface may come back
  }
}

std::optional<ReceivedFrame> SocketCanPort::Receive() {
  if (waiting_.empty() && state_ == CanState::kDown) Reopen();
  while (waiting_.empty()) {
    if (!ReadBatch()) return std::nullopt;
  }
  const ReceivedFrame frame = waiting_.front();
  waiting_.pop_front();
  ++counts_.received;
  return frame;
}

// Takes what the kernel has, up to kBatch frames in one call; false where it has none.
bool SocketCanPort::ReadBatch() {
  if (socket_ < 0) return false;
  struct Slot {
    can_frame raw;
    iovec part;
    alignas(cmsghdr) std::array<char, 128> control;
  };
  std::array<Slot, kBatch> slots{};
  std::array<mmsghdr, kBatch> messages{};
  for (size_t i = 0; i < kBatch; ++i) {
    slots[i].part = {&slots[i].raw, sizeof(can_frame)};
    messages[i].msg_hdr.msg_iov = &slots[i].part;
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = slots[i].control.data();
    messages[i].msg_hdr.msg_controllen = slots[i].control.size();
  }
  const int count = recvmmsg(socket_, messages.data(), kBatch, 0, nullptr);
  if (count <= 0) {
    OnReadError(errno);
    return false;
  }
  const int64_t realtime = RealtimeMicros();
  const int64_t now = clock_.NowMicros();
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const Ancillary ancillary = ReadAncillary(messages[i].msg_hdr, realtime);
    if (ancillary.drops) {
      counts_.overflowed += *ancillary.drops - kernel_drops_;
      kernel_drops_ = *ancillary.drops;
    }
    const CanFrame frame = ToFrame(slots[i].raw);
    if (messages[i].msg_len != sizeof(can_frame)) {
      ++counts_.malformed;
    } else if ((frame.id & CanFrame::kError) != 0) {
      OnErrorFrame(frame);
    } else {
      waiting_.push_back({frame, now - ancillary.age_micros});
    }
  }
  return true;
}

void SocketCanPort::OnReadError(int error) {
  if (error == EAGAIN || error == EINTR) return;
  state_ = CanState::kDown;  // ENETDOWN, ENODEV and whatever else there may be
}

void SocketCanPort::OnErrorFrame(const CanFrame& frame) {
  ++counts_.error_frames;
  if ((frame.id & CAN_ERR_BUSOFF) != 0) {
    ++counts_.bus_offs;
    state_ = CanState::kBusOff;
  }
  if ((frame.id & CAN_ERR_RESTARTED) == 0) return;
  next_open_micros_ = 0;
  Reopen();
}

void SocketCanPort::Send(std::span<const CanFrame> frames) {
  while (!frames.empty()) {
    const auto part = frames.first(std::min(frames.size(), kBatch));
    frames = frames.subspan(part.size());
    const size_t sent = state_ == CanState::kActive ? SendBatch(part) : 0;
    counts_.sent += static_cast<int64_t>(sent);
    counts_.unsent += static_cast<int64_t>(part.size() - sent);
  }
}

// How many of at most kBatch frames the kernel took.
size_t SocketCanPort::SendBatch(std::span<const CanFrame> frames) {
  std::array<can_frame, kBatch> raw{};
  std::array<iovec, kBatch> parts{};
  std::array<mmsghdr, kBatch> messages{};
  for (size_t i = 0; i < frames.size(); ++i) {
    raw[i].can_id = frames[i].id;
    raw[i].len = frames[i].length;
    std::copy_n(frames[i].data.begin(), frames[i].length, raw[i].data);
    parts[i] = {&raw[i], sizeof(can_frame)};
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int sent = sendmmsg(socket_, messages.data(), static_cast<unsigned>(frames.size()), 0);
  if (sent >= 0) return static_cast<size_t>(sent);
  if (errno == ENETDOWN || errno == ENODEV || errno == ENXIO) state_ = CanState::kDown;
  return 0;
}

}  // namespace hairpin
