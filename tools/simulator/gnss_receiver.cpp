#include "tools/simulator/gnss_receiver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "daemons/gnss_driver/frame_splitter.hpp"
#include "daemons/gnss_driver/ubx.hpp"

namespace hairpin {
namespace {

using Day = std::chrono::sys_days;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kKmhPerMps = 3.6;
constexpr double kKnotsPerMps = 3600.0 / 1852.0;
constexpr int64_t kSecond = 1'000'000;     // us
constexpr double kBaseline = 1.0;          // m, between the antennas
constexpr double kGeoidSeparation = 48.0;  // m, of central Europe
constexpr int kSatellites = 18;

/// UTC of a measurement. Receivers count in GPS time only within a week.
struct Calendar {
  explicit Calendar(int64_t utime)
      : time(std::chrono::microseconds(utime)),
        day(std::chrono::floor<std::chrono::days>(time)),
        date(day),
        micros((time - day).count()) {}
  int hour() const { return static_cast<int>(micros / kSecond / 3600); }
  int minute() const { return static_cast<int>(micros / kSecond / 60 % 60); }
  int second() const { return static_cast<int>(micros / kSecond % 60); }
  /// Milliseconds since Sunday.
  uint32_t time_of_week_ms() const {
    const int64_t days = std::chrono::weekday(day).c_encoding();
    return static_cast<uint32_t>((days * 86'400 * kSecond + micros) / 1'000);
  }

  std::chrono::sys_time<std::chrono::microseconds> time;
  Day day;
  std::chrono::year_month_day date;
  int64_t micros;  // of the day
};

/// A payload's fields, little-endian at their offsets.
class Payload {
 public:
  explicit Payload(size_t size) : bytes_(size) {}
  template <class Integer>
  void Put(size_t offset, Integer value) {
    for (size_t i = 0; i < sizeof(Integer); ++i)
      bytes_[offset + i] = static_cast<uint8_t>(static_cast<uint64_t>(value) >> (8 * i));
  }
  /// `value` in units of `unit`, to the nearest.
  void Put32(size_t offset, double value, double unit) {
    Put(offset, static_cast<int32_t>(std::lround(value / unit)));
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

// NAV-PVT: fix type, and flags with the carrier's solution in the upper bits.
std::pair<uint8_t, uint8_t> UbxFix(int32_t fix) {
  switch (fix) {
    case gnss_t::FIX_SINGLE:
      return {3, 0x01};
    case gnss_t::FIX_DIFFERENTIAL:
      return {3, 0x03};
    case gnss_t::FIX_FLOAT:
      return {3, 0x43};
    case gnss_t::FIX_RTK:
      return {3, 0x83};
    default:
      return {0, 0x00};
  }
}

char NmeaQuality(int32_t fix) {
  switch (fix) {
    case gnss_t::FIX_SINGLE:
      return '1';
    case gnss_t::FIX_DIFFERENTIAL:
      return '2';
    case gnss_t::FIX_FLOAT:
      return '5';
    case gnss_t::FIX_RTK:
      return '4';
    default:
      return '0';
  }
}

// Clockwise from north, as compasses and receivers have it.
double CompassDeg(double angle) {
  const double degrees = std::fmod(90.0 - angle * kDegPerRad, 360.0);
  return degrees < 0.0 ? degrees + 360.0 : degrees;
}

std::vector<uint8_t> NavPvt(const Calendar& at, const gnss_t& measured,
                            const GeodeticPoint& position) {
  Payload pvt(kUbxNavPvtSize);
  pvt.Put(0, at.time_of_week_ms());
  pvt.Put(4, static_cast<uint16_t>(static_cast<int>(at.date.year())));
  pvt.Put(6, static_cast<uint8_t>(static_cast<unsigned>(at.date.month())));
  pvt.Put(7, static_cast<uint8_t>(static_cast<unsigned>(at.date.day())));
  pvt.Put(8, static_cast<uint8_t>(at.hour()));
  pvt.Put(9, static_cast<uint8_t>(at.minute()));
  pvt.Put(10, static_cast<uint8_t>(at.second()));
  pvt.Put(11, uint8_t{0x07});  // date, time, and fully resolved
  pvt.Put(16, static_cast<int32_t>(at.micros % kSecond * 1'000));
  const auto [type, flags] = UbxFix(measured.fix);
  pvt.Put(20, type);
  pvt.Put(21, flags);
  pvt.Put(23, uint8_t{kSatellites});
  pvt.Put32(24, position.longitude_deg, 1e-7);
  pvt.Put32(28, position.latitude_deg, 1e-7);
  pvt.Put32(32, position.height_m, 1e-3);
  pvt.Put32(36, position.height_m - kGeoidSeparation, 1e-3);
  const double* sigma = measured.position_sigma_m;
  pvt.Put32(40, std::hypot(sigma[0], sigma[1]), 1e-3);
  pvt.Put32(44, sigma[2], 1e-3);
  const double* velocity = measured.velocity_enu_mps;
  pvt.Put32(48, velocity[1], 1e-3);
  pvt.Put32(52, velocity[0], 1e-3);
  pvt.Put32(56, -velocity[2], 1e-3);
  pvt.Put32(60, std::hypot(velocity[0], velocity[1]), 1e-3);
  pvt.Put32(64, CompassDeg(std::atan2(velocity[1], velocity[0])), 1e-5);
  pvt.Put32(68, measured.velocity_sigma_mps[0], 1e-3);
  return UbxFrame(kUbxNavPvt, pvt.bytes());
}

std::vector<uint8_t> NavRelPosNed(const Calendar& at, const gnss_t& measured) {
  constexpr uint32_t kFixOk = 1, kRelativeValid = 1 << 2, kFixed = 2 << 3, kHeadingValid = 1 << 8;
  Payload relative(kUbxNavRelPosNedSize);
  relative.Put(0, uint8_t{1});
  relative.Put(4, at.time_of_week_ms());
  relative.Put32(8, 100.0 * kBaseline * std::sin(measured.heading_rad), 1.0);
  relative.Put32(12, 100.0 * kBaseline * std::cos(measured.heading_rad), 1.0);
  relative.Put32(20, 100.0 * kBaseline, 1.0);
  relative.Put32(24, CompassDeg(measured.heading_rad), 1e-5);
  relative.Put32(52, measured.heading_sigma_rad * kDegPerRad, 1e-5);
  const bool is_valid = measured.heading_valid != 0;
  relative.Put(60, is_valid ? kFixOk | kRelativeValid | kFixed | kHeadingValid : kFixOk);
  return UbxFrame(kUbxNavRelPosNed, relative.bytes());
}

template <class... Values>
std::string Format(const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), format, values...);
  text.pop_back();
  return text;
}

// "ddmm.mmmmmmm,N", rounded as a whole, so that there is no sixtieth minute.
std::string NmeaAngle(double degrees, int digits, char positive, char negative) {
  constexpr int64_t kUnits = 10'000'000;  // in a minute
  const int64_t units = std::llround(std::abs(degrees) * 60.0 * kUnits);
  return Format("%0*d%02d.%07d,%c", digits, static_cast<int>(units / (60 * kUnits)),
                static_cast<int>(units / kUnits % 60), static_cast<int>(units % kUnits),
                degrees < 0.0 ? negative : positive);
}

}  // namespace

GnssReceiver::GnssReceiver(const GnssReceiverParams& params)
    : protocol_(params.protocol), plane_(params.origin) {}

std::vector<uint8_t> GnssReceiver::Epoch(const gnss_t& measured) const {
  const double* enu = measured.position_enu_m;
  const GeodeticPoint position = plane_.ToGeodetic({enu[0], enu[1], enu[2]});
  return protocol_ == GnssProtocol::kUbx ? Ubx(measured, position) : Nmea(measured, position);
}

std::vector<uint8_t> GnssReceiver::Ubx(const gnss_t& measured,
                                       const GeodeticPoint& position) const {
  const Calendar at(measured.utime);
  std::vector<uint8_t> bytes = NavPvt(at, measured, position);
  const std::vector<uint8_t> relative = NavRelPosNed(at, measured);
  bytes.insert(bytes.end(), relative.begin(), relative.end());
  return bytes;
}

std::vector<uint8_t> GnssReceiver::Nmea(const gnss_t& measured,
                                        const GeodeticPoint& position) const {
  const Calendar at(measured.utime);
  const std::string time = Format("%02d%02d%02d.%02d", at.hour(), at.minute(), at.second(),
                                  static_cast<int>(at.micros % kSecond / 10'000));
  const std::string place = NmeaAngle(position.latitude_deg, 2, 'N', 'S') + "," +
                            NmeaAngle(position.longitude_deg, 3, 'E', 'W');
  const double* velocity = measured.velocity_enu_mps;
  const double speed = std::hypot(velocity[0], velocity[1]);
  const double course = CompassDeg(std::atan2(velocity[1], velocity[0]));
  const double* sigma = measured.position_sigma_m;
  const std::string date =
      Format("%02u%02u%02d", static_cast<unsigned>(at.date.day()),
             static_cast<unsigned>(at.date.month()), static_cast<int>(at.date.year()) % 100);
  std::string text = NmeaFrame("GNGGA," + time + "," + place + "," + NmeaQuality(measured.fix) +
                               Format(",%d,0.7,%.4f,M,%.1f,M,,", kSatellites,
                                      position.height_m - kGeoidSeparation, kGeoidSeparation)) +
                     NmeaFrame("GNRMC," + time + ",A," + place + "," +
                               Format("%.4f,%.4f,", speed * kKnotsPerMps, course) + date + ",,,A") +
                     NmeaFrame("GNGST," + time + ",,,,," +
                               Format("%.4f,%.4f,%.4f", sigma[1], sigma[0], sigma[2])) +
                     NmeaFrame("GNVTG," + Format("%.4f,T,,M,%.4f,N,%.4f,K,A", course,
                                                 speed * kKnotsPerMps, speed * kKmhPerMps));
  text += NmeaFrame("GNHDT," +
                    (measured.heading_valid != 0 ? Format("%.4f", CompassDeg(measured.heading_rad))
                                                 : std::string()) +
                    ",T");
  return {text.begin(), text.end()};
}

}  // namespace hairpin
