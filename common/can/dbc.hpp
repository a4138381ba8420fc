#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/can/can_frame.hpp"
#include "common/can/checksum.hpp"
#include "hairpin/dbc.hpp"

namespace hairpin::dbc {

/// Name of a signal outside its range (NaN is); empty if none is.
template <class M>
std::string_view OutOfRange(const M& message) {
  std::string_view found;
  M::VisitSignals(message, [&found](const char* name, auto value, const Range& range) {
    const auto physical = static_cast<double>(value);
    if (!(physical >= range.min && physical <= range.max)) found = name;
  });
  return found;
}

/// The message with every signal moved into its range, as a sensor at its end of scale; NaN becomes
/// the lower end.
template <class M>
M Saturated(M message) {
  M::VisitSignals(message, [](const char*, auto& value, const Range& range) {
    const auto physical = static_cast<double>(value);
    using Value = std::decay_t<decltype(value)>;
    if (!(physical >= range.min)) value = static_cast<Value>(range.min);
    if (physical > range.max) value = static_cast<Value>(range.max);
  });
  return message;
}

/// The message's frame. A protected message's checksum is computed, whatever it says. Throws
/// std::invalid_argument, naming the signal, for a value outside its range.
template <class M>
CanFrame Pack(const M& message) {
  if (const std::string_view signal = OutOfRange(message); !signal.empty()) {
    throw std::invalid_argument(std::string(M::kName).append(": ").append(signal) +
                                " is out of range");
  }
  const uint64_t bits = M::ToBits(message);
  CanFrame frame{M::kId, M::kLength, {}};
  for (size_t i = 0; i < M::kLength; ++i) frame.data[i] = static_cast<uint8_t>(bits >> 8 * i);
  if constexpr (M::kProtected) frame.data[M::kLength - 1] = ProtectionOf(frame);
  return frame;
}

/// What is wrong with a frame of M's identifier: "length", "checksum", "range of SIGNAL"; empty,
/// and `message` filled, if nothing is.
template <class M>
std::string Unpack(const CanFrame& frame, M& message) {
  if (frame.length != M::kLength) return "length";
  if constexpr (M::kProtected) {
    if (frame.data[M::kLength - 1] != ProtectionOf(frame)) return "checksum";
  }
  uint64_t bits = 0;
  for (size_t i = 0; i < M::kLength; ++i) bits |= uint64_t{frame.data[i]} << 8 * i;
  const M unpacked = M::FromBits(bits);
  if (const std::string_view signal = OutOfRange(unpacked); !signal.empty())
    return std::string("range of ").append(signal);
  message = unpacked;
  return {};
}

/// Packs one kind of message, its counter going up.
template <class M>
class Sender {
 public:
  CanFrame Pack(M message) {
    if constexpr (M::kProtected) message.counter = counter_++ & 0x0Fu;
    return dbc::Pack(message);
  }

 private:
  uint8_t counter_ = 0;
};

/// Unpacks one kind of message and follows its counter: what may be believed, as of AUTOSAR's
/// end-to-end profile 1.
template <class M>
class Receiver {
 public:
  static constexpr int kMaxCounterStep = 3;  // up to two frames lost in a row

  /// As Unpack(), and for protected messages "counter repeats", "counter jumps". The first frame
  /// is taken as it comes, and so is the one after a jump.
  std::string Unpack(const CanFrame& frame, M& message) {
    M received;
    std::string problem = dbc::Unpack(frame, received);
    if constexpr (M::kProtected) {
      if (problem.empty() && counter_) {
        const int step = (received.counter - *counter_) & 0x0F;
        if (step == 0) problem = "counter repeats";
        if (step > kMaxCounterStep) problem = "counter jumps";
      }
      if (problem.empty() || problem == "counter jumps") counter_ = received.counter;
    }
    if (problem.empty()) message = received;
    return problem;
  }

 private:
  std::optional<uint8_t> counter_;
};

}  // namespace hairpin::dbc

namespace hairpin {

/// Identifiers of all frames that the computer sends, and of all that the car does: what the
/// kernel is to let through to the other.
inline std::vector<uint32_t> IdsOfTheComputer() {
  std::vector<uint32_t> ids;
  dbc::ForEachMessage([&ids]<class M>(const M&) {
    if (M::kFromComputer) ids.push_back(M::kId);
  });
  return ids;
}
inline std::vector<uint32_t> IdsOfTheCar() {
  std::vector<uint32_t> ids;
  dbc::ForEachMessage([&ids]<class M>(const M&) {
    if (!M::kFromComputer) ids.push_back(M::kId);
  });
  return ids;
}

}  // namespace hairpin
