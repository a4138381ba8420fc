#include "daemons/gnss_driver/nmea.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

namespace hairpin {
namespace {

constexpr double kKnot = 1852.0 / 3600.0;  // m/s
constexpr double kKmh = 1.0 / 3.6;         // m/s
constexpr double kDegree = M_PI / 180.0;   // rad
constexpr double kMaxSpeed = 200.0;        // m/s
constexpr size_t kMaxFields = 40;

/// The comma-separated fields of a sentence; empty past the end.
class Fields {
 public:
  explicit Fields(std::string_view text) {
    while (fields_.size() < kMaxFields) {
      const size_t comma = text.find(',');
      fields_.push_back(text.substr(0, comma));
      if (comma == std::string_view::npos) return;
      text.remove_prefix(comma + 1);
    }
    throw GnssFormatError("NMEA sentence with too many fields");
  }

  std::string_view Text(size_t index) const {
    return index < fields_.size() ? fields_[index] : std::string_view();
  }

  std::optional<double> Number(size_t index, double min, double max) const {
    const std::string_view text = Text(index);
    if (text.empty()) return std::nullopt;
    double value = 0.0;
    const auto [stop, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (error != std::errc() || stop != text.data() + text.size())
      throw GnssFormatError("NMEA field is no number");
    if (!(value >= min && value <= max)) throw GnssFormatError("NMEA field out of range");
    return value;
  }

  /// "hhmmss.ss"
  std::optional<TimeOfDay> Time(size_t index) const {
    const std::optional<double> value = Number(index, 0.0, 235960.999999);
    if (!value) return std::nullopt;
    const auto hhmm = static_cast<int64_t>(*value) / 100;
    const double seconds = *value - static_cast<double>(hhmm * 100);
    if (hhmm % 100 > 59 || seconds >= 61.0) throw GnssFormatError("NMEA time out of range");
    return (hhmm / 100 * 3600 + hhmm % 100 * 60) * 1'000'000 + std::llround(seconds * 1e6);
  }

  /// "dddmm.mmmm" and its hemisphere in the next field, degrees.
  std::optional<double> Angle(size_t index, char positive, char negative, double max) const {
    const std::optional<double> value = Number(index, 0.0, 18000.0);
    if (!value) return std::nullopt;
    const double degrees = std::floor(*value / 100.0);
    const double minutes = *value - 100.0 * degrees;
    const std::string_view side = Text(index + 1);
    const bool is_sided = side.size() == 1 && (side[0] == positive || side[0] == negative);
    const double angle = degrees + minutes / 60.0;
    if (!is_sided || minutes >= 60.0 || angle > max)
      throw GnssFormatError("NMEA position out of range");
    return side[0] == positive ? angle : -angle;
  }

 private:
  std::vector<std::string_view> fields_;
};

FixType TypeOf(std::string_view quality) {
  if (quality.size() != 1) return FixType::kNone;
  switch (quality[0]) {
    case '1':
    case '3':  // precise positioning service
      return FixType::kSingle;
    case '2':
      return FixType::kDifferential;
    case '4':
      return FixType::kRtk;
    case '5':
      return FixType::kFloat;
    default:  // none, dead reckoned, entered by hand, simulated: not measured
      return FixType::kNone;
  }
}

std::optional<Eigen::Vector2d> VelocityOf(std::optional<double> course_deg,
                                          std::optional<double> speed) {
  if (!speed) return std::nullopt;
  // Receivers leave out the course of a car that stands.
  const double course = course_deg.value_or(0.0) * kDegree;
  return Eigen::Vector2d(*speed * std::sin(course), *speed * std::cos(course));
}

std::optional<NmeaMessage> ParseGga(const Fields& fields) {
  const std::optional<TimeOfDay> time = fields.Time(1);
  if (!time) return std::nullopt;
  NmeaGga gga{.time = *time, .type = TypeOf(fields.Text(6)), .position = {}, .dilution = 1.0};
  const std::optional<double> latitude = fields.Angle(2, 'N', 'S', 90.0);
  const std::optional<double> longitude = fields.Angle(4, 'E', 'W', 180.0);
  const double altitude = fields.Number(9, -1e4, 1e5).value_or(0.0);
  const double separation = fields.Number(11, -200.0, 200.0).value_or(0.0);
  gga.dilution = std::max(1.0, fields.Number(8, 0.0, 1e3).value_or(1.0));
  if (latitude && longitude)
    gga.position = GeodeticPoint{*latitude, *longitude, altitude + separation};
  if (!gga.position) gga.type = FixType::kNone;
  return gga;
}

std::optional<NmeaMessage> ParseRmc(const Fields& fields) {
  const std::optional<TimeOfDay> time = fields.Time(1);
  const std::optional<double> date = fields.Number(9, 10100.0, 311299.0);  // ddmmyy
  if (!time || !date) return std::nullopt;
  const auto ddmmyy = static_cast<unsigned>(*date);
  const std::chrono::year_month_day day{std::chrono::year(2000 + static_cast<int>(ddmmyy % 100)),
                                        std::chrono::month(ddmmyy / 100 % 100),
                                        std::chrono::day(ddmmyy / 10000)};
  if (!day.ok()) throw GnssFormatError("NMEA date out of range");
  const std::chrono::microseconds midnight = std::chrono::sys_days(day).time_since_epoch();
  NmeaRmc rmc{.time = *time, .day_utime = midnight.count(), .velocity = {}};
  const std::optional<double> knots = fields.Number(7, 0.0, kMaxSpeed / kKnot);
  const std::optional<double> course = fields.Number(8, 0.0, 360.0);
  if (fields.Text(2) == "A" && knots) rmc.velocity = VelocityOf(course, *knots * kKnot);
  return rmc;
}

NmeaMessage ParseVtg(const Fields& fields) {
  const std::optional<double> course = fields.Number(1, 0.0, 360.0);
  const std::optional<double> kmh = fields.Number(7, 0.0, kMaxSpeed / kKmh);
  const bool is_valid = fields.Text(9) != "N";
  return NmeaVtg{is_valid && kmh ? VelocityOf(course, *kmh * kKmh) : std::nullopt};
}

NmeaMessage ParseHdt(const Fields& fields) {
  const std::optional<double> heading = fields.Number(1, 0.0, 360.0);
  if (!heading) return NmeaHdt{};
  return NmeaHdt{M_PI_2 - *heading * kDegree};
}

std::optional<NmeaMessage> ParseGst(const Fields& fields) {
  const std::optional<TimeOfDay> time = fields.Time(1);
  if (!time) return std::nullopt;
  const std::optional<double> north = fields.Number(6, 0.0, 1e5);
  const std::optional<double> east = fields.Number(7, 0.0, 1e5);
  const std::optional<double> up = fields.Number(8, 0.0, 1e5);
  NmeaGst gst{.time = *time, .sigma = {}};
  if (north && east && up) gst.sigma = Eigen::Vector3d(*east, *north, *up);
  return gst;
}

}  // namespace

std::optional<NmeaMessage> ParseNmea(std::string_view text) {
  // Two letters name the talker, three the sentence; proprietary ones begin with P.
  const std::string_view address = text.substr(0, text.find(','));
  if (address.size() != 5 || address[0] == 'P') return std::nullopt;
  const std::string_view kind = address.substr(2);
  if (kind == "GGA") return ParseGga(Fields(text));
  if (kind == "RMC") return ParseRmc(Fields(text));
  if (kind == "VTG") return ParseVtg(Fields(text));
  if (kind == "HDT") return ParseHdt(Fields(text));
  if (kind == "GST") return ParseGst(Fields(text));
  return std::nullopt;
}

}  // namespace hairpin
