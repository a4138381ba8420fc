#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/cone.hpp"
#include "common/local_enu.hpp"
#include "daemons/gnss_driver/gnss_fix.hpp"

namespace hairpin {

struct SurveyParams {
  double averaging_s = 0.0;    // of fixes behind one point
  int min_fixes = 0;           // among them
  double max_scatter_m = 0.0;  // a fix farther from the others' mean: the antenna moved
  double max_sigma_m = 0.0;    // horizontal, of a fix that counts
  double stale_s = 0.0;        // without a fix
  double min_spacing_m = 0.0;  // a cone nearer to another is the same one
};

/// What a point is: a cone of a colour, where the car will stand, or a point straight ahead of it.
enum class PointKind { kBlue, kYellow, kOrange, kOrangeLarge, kStart, kAhead };
std::string NameOf(PointKind kind);
std::optional<PointKind> PointKindFromName(const std::string& name);
std::optional<ConeColour> ColourOf(PointKind kind);

/// A surveyed point: the mean of its fixes.
struct SurveyedPoint {
  PointKind kind = PointKind::kBlue;
  int64_t utime = 0;
  GeodeticPoint position;
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  // east, north, up [m]
  int fixes = 0;
};

/// What came of a key or a fix, with a word for the person that walks.
struct SurveyAnswer {
  std::optional<SurveyedPoint> accepted;
  bool is_undone = false;  // the last point was taken back
  std::string word;        // empty: nothing to say
};

/// From keys and fixes to points. A key begins a point; the fixes of the next seconds are averaged,
/// while the antenna stands. Refused with a word: float or worse solutions, stale ones, an antenna
/// that moves, a cone that stands already. Times [us]: `utime` of the receiver, `now` of any
/// monotonic clock.
class Survey {
 public:
  explicit Survey(const SurveyParams& params) : params_(params) {}

  SurveyAnswer Press(PointKind kind, int64_t now);
  /// Takes back the point under way, else the last one.
  SurveyAnswer Undo();
  SurveyAnswer Add(const GnssFix& fix, int64_t now);
  /// To be called now and then: notices a receiver that fell silent.
  SurveyAnswer Wait(int64_t now);

  /// A point of an earlier sitting, from its journal.
  void Restore(const SurveyedPoint& point);

  const std::vector<SurveyedPoint>& points() const { return points_; }

 private:
  struct UnderWay {
    PointKind kind = PointKind::kBlue;
    std::vector<GnssFix> fixes;
  };
  SurveyAnswer Refuse(const std::string& why);
  SurveyAnswer Finish();
  Eigen::Vector3d ToEnu(const GeodeticPoint& point) const;
  std::optional<size_t> Doubled(PointKind kind, const GeodeticPoint& position) const;

  SurveyParams params_;
  std::vector<SurveyedPoint> points_;
  std::optional<UnderWay> under_way_;
  std::optional<GnssFix> last_fix_;
  int64_t last_fix_now_ = 0;
  std::optional<LocalEnu> plane_;
};

}  // namespace hairpin
