#include "daemons/lidar_driver/position_packet.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

namespace hairpin {
namespace {

constexpr size_t kTimeOffset = 198;
constexpr size_t kPpsOffset = 202;
constexpr size_t kSentenceOffset = 206;
constexpr uint8_t kPpsLocked = 2;
constexpr uint32_t kHour = 3'600'000'000;  // us
constexpr size_t kMaxFields = 20;

std::optional<int> ToInteger(std::string_view digits, int base = 10) {
  int value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc() || end != digits.data() + digits.size() || value < 0)
    return std::nullopt;
  return value;
}

// "$" body "*" two hex digits; empty where the checksum does not fit.
std::optional<std::string_view> CheckedBody(std::string_view sentence) {
  const size_t star = sentence.find('*');
  if (!sentence.starts_with('$') || star == std::string_view::npos || star + 3 > sentence.size())
    return std::nullopt;
  const std::string_view body = sentence.substr(1, star - 1);
  int checksum = 0;
  for (const char letter : body) checksum ^= static_cast<unsigned char>(letter);
  if (ToInteger(sentence.substr(star + 1, 2), 16) != checksum) return std::nullopt;
  return body;
}

// Three numbers of two digits each.
std::optional<std::array<int, 3>> Triple(std::string_view text) {
  std::array<int, 3> numbers{};
  for (size_t i = 0; i < 3; ++i) {
    const auto number = text.size() < 2 * i + 2 ? std::nullopt : ToInteger(text.substr(2 * i, 2));
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace

std::optional<int64_t> ParseRmcTime(std::string_view sentence) {
  const auto body = CheckedBody(sentence);
  if (!body) return std::nullopt;
  std::array<std::string_view, kMaxFields> fields;
  size_t begin = 0;
  for (std::string_view& field : fields) {
    const size_t end = std::min(body->find(',', begin), body->size());
    field = body->substr(begin, end - begin);
    if (end == body->size()) break;
    begin = end + 1;
  }
  if ((fields[0] != "GPRMC" && fields[0] != "GNRMC") || fields[2] != "A") return std::nullopt;
  const auto time = Triple(fields[1]);
  const auto date = Triple(fields[9]);
  if (!time || !date || fields[9].size() != 6) return std::nullopt;
  const auto [hour, minute, second] = *time;
  const auto [day, month, short_year] = *date;
  const std::chrono::year_month_day calendar{
      std::chrono::year{short_year + (short_year >= 80 ? 1900 : 2000)},
      std::chrono::month{static_cast<unsigned>(month)},
      std::chrono::day{static_cast<unsigned>(day)}};
  if (!calendar.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  const auto since_epoch = std::chrono::sys_days{calendar}.time_since_epoch() +
                           std::chrono::hours{hour} + std::chrono::minutes{minute} +
                           std::chrono::seconds{second};
  return std::chrono::duration_cast<std::chrono::microseconds>(since_epoch).count();
}

std::optional<PositionPacket> DecodePositionPacket(std::span<const uint8_t> packet) {
  if (packet.size() != kPositionPacketSize) return std::nullopt;
  PositionPacket position;
  for (size_t i = 4; i-- > 0;) position.time_us = position.time_us << 8 | packet[kTimeOffset + i];
  if (position.time_us >= kHour) return std::nullopt;
  position.pps_locked = packet[kPpsOffset] == kPpsLocked;
  const auto text = packet.subspan(kSentenceOffset);
  const auto end = std::find(text.begin(), text.end(), uint8_t{0});
  position.gps_utime = ParseRmcTime(
      {reinterpret_cast<const char*>(text.data()), static_cast<size_t>(end - text.begin())});
  return position;
}

}  // namespace hairpin
