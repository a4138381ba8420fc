#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemons/gnss_driver/frame_splitter.hpp"
#include "daemons/gnss_driver/gnss_fix.hpp"
#include "daemons/gnss_driver/nmea.hpp"
#include "daemons/gnss_driver/ubx.hpp"

namespace hairpin {

/// A receiver's bytes in, fixes out. NMEA (GGA, RMC, VTG, HDT, GST) and UBX (NAV-PVT,
/// NAV-RELPOSNED); from the first NAV-PVT on NMEA says nothing new and is ignored.
///
/// A receiver tells of one epoch in several messages. A fix comes out once every kind of message
/// has arrived that the epoch before had, so without waiting; where one is missing, with the first
/// message of the next epoch.
class GnssDecoder {
 public:
  static constexpr const char* kTimeDoesNotIncrease = "time does not increase";

  /// `errors`: what stands in where the receiver does not say how good it is.
  explicit GnssDecoder(const GnssErrorModel& errors);
  GnssDecoder(const GnssDecoder&) = delete;
  GnssDecoder& operator=(const GnssDecoder&) = delete;

  /// The fixes that these bytes complete, in order of increasing time.
  std::vector<GnssFix> Add(Bytes bytes);
  /// The epoch that waits for the rest of its messages, at the end of a recording.
  std::optional<GnssFix> Flush();

  /// Frames thrown away so far, by reason; fixes too whose time does not increase.
  const std::map<std::string, int64_t>& bad() const { return bad_; }

 private:
  enum Kind : uint32_t { kGga = 1, kRmc = 2, kVtg = 4, kHdt = 8, kGst = 16, kPvt = 32, kRel = 64 };
  struct Epoch {
    int64_t key = 0;
    uint32_t heard = 0;
    bool is_out = false;
    GnssFix fix;  // utime is set once the date is known
    bool has_position = false;
    double dilution = 1.0;
    std::optional<Eigen::Vector3d> sigma;
  };
  struct Date {
    int64_t day_utime = 0;
    TimeOfDay time = 0;
  };

  void OnNmea(std::string_view text);
  void OnUbx(uint16_t class_and_id, Bytes payload);
  void Take(const NmeaGga& gga);
  void Take(const NmeaRmc& rmc);
  void Take(const NmeaVtg& vtg);
  void Take(const NmeaHdt& hdt);
  void Take(const NmeaGst& gst);
  void TakeVelocity(const Eigen::Vector2d& velocity);
  Epoch& At(int64_t key);
  void Heard(Kind kind);
  void Emit();
  void CountBad(std::string_view why) { ++bad_[std::string(why)]; }
  std::optional<int64_t> UtimeOf(const Epoch& epoch) const;
  Eigen::Vector3d PositionSigma(const Epoch& epoch) const;

  GnssErrorModel errors_;
  FrameSplitter splitter_;
  std::optional<Epoch> epoch_;
  uint32_t expected_ = 0;  // kinds that the last epoch had
  std::optional<Date> date_;
  bool is_ubx_ = false;
  std::optional<int64_t> last_utime_;
  std::vector<GnssFix> fixes_;
  std::map<std::string, int64_t> bad_;
};

}  // namespace hairpin
