#include "daemons/gnss_driver/frame_splitter.hpp"

#include <algorithm>
#include <charconv>

namespace hairpin {
namespace {

constexpr uint8_t kSync1 = 0xb5;
constexpr uint8_t kSync2 = 0x62;
constexpr size_t kUbxHeader = 6;    // sync, class, id, length
constexpr size_t kUbxOverhead = 8;  // and the checksum
constexpr uint8_t kNovatelSync[] = {0xaa, 0x44};
constexpr uint8_t kNovatelLong = 0x12;
constexpr uint8_t kNovatelShort = 0x13;
constexpr size_t kNovatelShortHeader = 12;
constexpr size_t kNovatelLengths = 10;  // by then both kinds have said how long they are
constexpr size_t kNovatelChecksum = 4;

bool IsPrintable(uint8_t byte) { return byte >= 0x20 && byte < 0x7f; }

}  // namespace

uint8_t NmeaChecksum(std::string_view text) {
  uint8_t sum = 0;
  for (const char c : text) sum = static_cast<uint8_t>(sum ^ static_cast<uint8_t>(c));
  return sum;
}

uint16_t UbxChecksum(Bytes bytes) {
  uint8_t a = 0;
  uint8_t b = 0;
  for (const uint8_t byte : bytes) {
    a = static_cast<uint8_t>(a + byte);
    b = static_cast<uint8_t>(b + a);
  }
  return static_cast<uint16_t>(a | b << 8);
}

uint32_t NovatelChecksum(Bytes bytes) {
  uint32_t sum = 0;
  for (const uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return sum;
}

std::string NmeaFrame(std::string_view text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  const uint8_t sum = NmeaChecksum(text);
  std::string frame = "$";
  frame += text;
  frame += '*';
  frame += kDigits[sum >> 4];
  frame += kDigits[sum & 15];
  return frame + "\r\n";
}

std::vector<uint8_t> UbxFrame(uint16_t class_and_id, Bytes payload) {
  const auto byte = [](size_t value) { return static_cast<uint8_t>(value & 0xff); };
  std::vector<uint8_t> frame;
  frame.reserve(payload.size() + kUbxOverhead);
  for (const size_t value : {size_t{kSync1}, size_t{kSync2}, size_t{class_and_id} >> 8,
                             size_t{class_and_id}, payload.size(), payload.size() >> 8}) {
    frame.push_back(byte(value));
  }
  for (const uint8_t value : payload) frame.push_back(value);
  const uint16_t sum = UbxChecksum(Bytes(frame).subspan(2));
  frame.push_back(byte(sum));
  frame.push_back(byte(sum >> 8));
  return frame;
}

void FrameSplitter::Add(Bytes bytes) {
  for (const uint8_t byte : bytes) {
    buffer_.push_back(byte);
    while (!rest().empty() && TakeFrame() != Verdict::kNeedsMore) {
    }
    if (begin_ == buffer_.size() || begin_ > kMaxPayload) {
      buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
      begin_ = 0;
    }
  }
}

FrameSplitter::Verdict FrameSplitter::TakeFrame() {
  const uint8_t first = rest().front();
  if (first == '$') return TakeSentence();
  if (first == kSync1) return TakeUbx();
  if (first == kNovatelSync[0]) return RefuseNovatel();
  Drop(1);  // line ends, other protocols
  return Verdict::kTaken;
}

FrameSplitter::Verdict FrameSplitter::Bad(std::string_view why) {
  handlers_.on_bad(why);
  Drop(1);
  return Verdict::kBad;
}

FrameSplitter::Verdict FrameSplitter::TakeSentence() {
  const Bytes bytes = rest().subspan(1);
  const auto end = std::find_if_not(bytes.begin(), bytes.end(), IsPrintable);
  const auto length = static_cast<size_t>(end - bytes.begin());
  if (length > kMaxSentence) return Bad("NMEA sentence too long");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), length);
  const size_t star = text.find('*');
  const bool is_ended = end != bytes.end();
  if (star == std::string_view::npos)
    return is_ended ? Bad("NMEA sentence without checksum") : Verdict::kNeedsMore;
  if (text.size() < star + 3)
    return is_ended ? Bad("NMEA sentence without checksum") : Verdict::kNeedsMore;
  unsigned stated = 0;
  const char* digits = text.data() + star + 1;
  const auto [stop, error] = std::from_chars(digits, digits + 2, stated, 16);
  if (error != std::errc() || stop != digits + 2 || stated != NmeaChecksum(text.substr(0, star)))
    return Bad("NMEA checksum wrong");
  handlers_.on_nmea(text.substr(0, star));
  Drop(star + 4);
  return Verdict::kTaken;
}

FrameSplitter::Verdict FrameSplitter::TakeUbx() {
  const Bytes bytes = rest();
  if (bytes.size() >= 2 && bytes[1] != kSync2) {
    Drop(1);
    return Verdict::kTaken;
  }
  if (bytes.size() < kUbxHeader) return Verdict::kNeedsMore;
  const size_t length = LittleEndian<uint16_t>(bytes, 4);
  if (length > kMaxPayload) return Bad("UBX frame too long");
  if (bytes.size() < length + kUbxOverhead) return Verdict::kNeedsMore;
  const uint16_t stated = LittleEndian<uint16_t>(bytes, kUbxHeader + length);
  if (stated != UbxChecksum(bytes.subspan(2, length + 4))) return Bad("UBX checksum wrong");
  const auto class_and_id = static_cast<uint16_t>(bytes[2] << 8 | bytes[3]);
  handlers_.on_ubx(class_and_id, bytes.subspan(kUbxHeader, length));
  Drop(length + kUbxOverhead);
  return Verdict::kTaken;
}

FrameSplitter::Verdict FrameSplitter::RefuseNovatel() {
  const Bytes bytes = rest();
  const auto is = [bytes](size_t at, uint8_t value) { return bytes[at] == value; };
  const bool is_other = (bytes.size() >= 2 && !is(1, kNovatelSync[1])) ||
                        (bytes.size() >= 3 && !is(2, kNovatelLong) && !is(2, kNovatelShort));
  if (is_other) {
    Drop(1);
    return Verdict::kTaken;
  }
  if (bytes.size() < kNovatelLengths) return Verdict::kNeedsMore;
  const size_t length = is(2, kNovatelLong) ? bytes[3] + LittleEndian<uint16_t>(bytes, 8)
                                            : kNovatelShortHeader + bytes[3];
  if (length > kMaxPayload) return Bad("NovAtel log too long");
  if (bytes.size() < length + kNovatelChecksum) return Verdict::kNeedsMore;
  if (LittleEndian<uint32_t>(bytes, length) != NovatelChecksum(bytes.first(length)))
    return Bad("NovAtel checksum wrong");
  handlers_.on_bad("NovAtel binary log: have the receiver send NMEA");
  Drop(length + kNovatelChecksum);
  return Verdict::kTaken;
}

}  // namespace hairpin
