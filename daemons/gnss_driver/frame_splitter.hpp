#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "daemons/gnss_driver/byte_reader.hpp"

namespace hairpin {

/// What the splitter finds, whole and with its checksum right.
struct FrameHandlers {
  std::function<void(std::string_view)> on_nmea;  // between '$' and '*': "GPGGA,123519,..."
  std::function<void(uint16_t, Bytes)> on_ubx;    // class and id (0x0107), payload
  std::function<void(std::string_view)> on_bad;   // why a frame was thrown away
};

/// Cuts a receiver's bytes, in pieces of any size, into NMEA 0183 sentences and UBX frames, which
/// may alternate, with rubbish in between. NovAtel's binary logs are thrown away whole, by name:
/// such a receiver is to send NMEA. Holds kMaxFrame bytes at most. A frame that turns out
/// bad costs its first byte only: the next may start inside it.
class FrameSplitter {
 public:
  explicit FrameSplitter(FrameHandlers handlers) : handlers_(std::move(handlers)) {}
  void Add(Bytes bytes);

  static constexpr size_t kMaxSentence = 160;  // 82 by the standard; proprietary ones are longer
  static constexpr size_t kMaxPayload = 2048;  // NAV-SAT of 170 satellites

 private:
  enum class Verdict { kNeedsMore, kTaken, kBad };
  Verdict TakeFrame();
  Verdict TakeSentence();
  Verdict TakeUbx();
  Verdict RefuseNovatel();
  Verdict Bad(std::string_view why);
  void Drop(size_t count) { begin_ += count; }
  Bytes rest() const { return Bytes(buffer_).subspan(begin_); }

  FrameHandlers handlers_;
  std::vector<uint8_t> buffer_;
  size_t begin_ = 0;  // of what is not yet done with
};

/// XOR of the characters between '$' and '*'.
uint8_t NmeaChecksum(std::string_view text);
/// Fletcher's checksum over class, id, length and payload [u-blox interface description].
uint16_t UbxChecksum(Bytes bytes);

/// CRC-32 of NovAtel's logs, headers included [OEM7 Commands and Logs, OM-20000169].
uint32_t NovatelChecksum(Bytes bytes);

/// The wire forms, for whoever plays the receiver: "$text*hh\r\n", and a framed UBX message.
std::string NmeaFrame(std::string_view text);
std::vector<uint8_t> UbxFrame(uint16_t class_and_id, Bytes payload);

}  // namespace hairpin
