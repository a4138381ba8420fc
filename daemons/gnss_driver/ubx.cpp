#include "daemons/gnss_driver/ubx.hpp"

#include <chrono>
#include <cmath>

namespace hairpin {
namespace {

constexpr double kMilli = 1e-3;
constexpr double kDegree = M_PI / 180.0;

int64_t UtimeOf(Bytes payload) {
  const std::chrono::year_month_day day{std::chrono::year(LittleEndian<uint16_t>(payload, 4)),
                                        std::chrono::month(payload[6]),
                                        std::chrono::day(payload[7])};
  if (!day.ok() || payload[8] > 23 || payload[9] > 59 || payload[10] > 60)
    throw GnssFormatError("UBX date out of range");
  const int64_t seconds = payload[8] * 3600 + payload[9] * 60 + payload[10];
  const auto nano = LittleEndian<int32_t>(payload, 16);
  const std::chrono::microseconds midnight = std::chrono::sys_days(day).time_since_epoch();
  return midnight.count() + seconds * 1'000'000 + std::llround(nano * 1e-3);
}

FixType TypeOf(uint8_t fix_type, uint8_t flags) {
  const bool is_measured = fix_type == 2 || fix_type == 3 || fix_type == 4;
  if (!is_measured || !(flags & 1)) return FixType::kNone;
  switch (flags >> 6) {  // carrier solution
    case 1:
      return FixType::kFloat;
    case 2:
      return FixType::kRtk;
    default:
      return flags & 2 ? FixType::kDifferential : FixType::kSingle;
  }
}

}  // namespace

std::optional<UbxNavPvt> ParseNavPvt(Bytes payload) {
  if (payload.size() != kUbxNavPvtSize) throw GnssFormatError("UBX NAV-PVT of wrong length");
  const uint8_t valid = payload[11];
  if ((valid & 3) != 3) return std::nullopt;  // date and time
  UbxNavPvt pvt;
  pvt.time_of_week_ms = LittleEndian<uint32_t>(payload, 0);
  GnssFix& fix = pvt.fix;
  fix.utime = UtimeOf(payload);
  fix.type = TypeOf(payload[20], payload[21]);
  fix.position = {1e-7 * LittleEndian<int32_t>(payload, 28),
                  1e-7 * LittleEndian<int32_t>(payload, 24),
                  kMilli * LittleEndian<int32_t>(payload, 32)};
  if (std::abs(fix.position.latitude_deg) > 90.0 || std::abs(fix.position.longitude_deg) > 180.0)
    throw GnssFormatError("UBX position out of range");
  // The accuracies are of the horizontal position as a whole, hence the root of two per axis.
  const double horizontal = kMilli * LittleEndian<uint32_t>(payload, 40) * M_SQRT1_2;
  fix.position_sigma = {horizontal, horizontal, kMilli * LittleEndian<uint32_t>(payload, 44)};
  fix.velocity = {kMilli * LittleEndian<int32_t>(payload, 52),
                  kMilli * LittleEndian<int32_t>(payload, 48),
                  -kMilli * LittleEndian<int32_t>(payload, 56)};
  fix.velocity_sigma.setConstant(kMilli * LittleEndian<uint32_t>(payload, 68));
  fix.has_velocity = true;
  return pvt;
}

UbxNavRelPosNed ParseNavRelPosNed(Bytes payload) {
  if (payload.size() != kUbxNavRelPosNedSize || payload[0] != 1)
    throw GnssFormatError("UBX NAV-RELPOSNED of wrong length or version");
  UbxNavRelPosNed relative;
  relative.time_of_week_ms = LittleEndian<uint32_t>(payload, 4);
  const auto flags = LittleEndian<uint32_t>(payload, 60);
  constexpr uint32_t kFixOk = 1, kRelativeValid = 1 << 2, kHeadingValid = 1 << 8;
  constexpr uint32_t kNeeded = kFixOk | kRelativeValid | kHeadingValid;
  if ((flags & kNeeded) != kNeeded) return relative;
  const double heading_deg = 1e-5 * LittleEndian<int32_t>(payload, 24);
  if (std::abs(heading_deg) > 360.0) throw GnssFormatError("UBX heading out of range");
  relative.heading = M_PI_2 - heading_deg * kDegree;
  relative.heading_sigma = 1e-5 * LittleEndian<uint32_t>(payload, 52) * kDegree;
  return relative;
}

}  // namespace hairpin
