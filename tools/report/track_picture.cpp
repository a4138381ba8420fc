#include <algorithm>
#include <array>
#include <cmath>

#include "tools/report/map_comparison.hpp"
#include "tools/report/pictures.hpp"
#include "tools/report/race_line_metrics.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/report/true_track.hpp"
#include "tools/report/view.hpp"

namespace hairpin {
namespace {

constexpr double kWidth = View::kWidth;
constexpr double kSide = View::kSide;
constexpr double kStrokeStep = 0.5;  // m of the driven line
constexpr int kNumMoments = 6;
constexpr int kNumColours = 16;

using Points = std::vector<Eigen::Vector2d>;

struct Rgb {
  double red, green, blue;
};

/// From slow to fast, lightness rising; all of it stands out from the asphalt and from the cones.
constexpr std::array<Rgb, 4> kSpeedRamp{
    {{122, 92, 255}, {232, 62, 160}, {255, 140, 60}, {255, 242, 200}}};

std::string SpeedColour(int level) {
  const double position = (kSpeedRamp.size() - 1.0) * level / (kNumColours - 1.0);
  const auto i = std::min(static_cast<size_t>(position), kSpeedRamp.size() - 2);
  const double share = position - static_cast<double>(i);
  const auto channel = [share](double a, double b) { return Fixed(std::lerp(a, b, share), 0); };
  return "rgb(" + channel(kSpeedRamp[i].red, kSpeedRamp[i + 1].red) + "," +
         channel(kSpeedRamp[i].green, kSpeedRamp[i + 1].green) + "," +
         channel(kSpeedRamp[i].blue, kSpeedRamp[i + 1].blue) + ")";
}

Points Positions(const std::vector<truth_cone_t>& cones) {
  Points points;
  for (const truth_cone_t& cone : cones) points.emplace_back(cone.x_m, cone.y_m);
  return points;
}

double TopSpeed(const RunLog& log) {
  double top = 1.0;
  for (const truth_t& truth : log.truth)
    top = std::max(top, std::hypot(truth.vx_mps, truth.vy_mps));
  return top;
}

void DrawAsphalt(const truth_track_t& track, const View& view, Svg& svg) {
  Points left = view(Positions(track.left));
  Points right = view(Positions(track.right));
  std::reverse(right.begin(), right.end());
  if (track.closed) {
    svg.Area({left, right}, "asphalt");
  } else {
    left.insert(left.end(), right.begin(), right.end());
    svg.Area({left}, "asphalt");
  }
  const double* line = track.finish_line_m;
  svg.Line(view({line[0], line[1]}), view({line[2], line[3]}), "gate");
}

void DrawDrivenLine(const RunLog& log, const View& view, Svg& svg) {
  const double top = TopSpeed(log);
  Points stroke;
  int stroke_level = 0;
  double last_distance = 0.0;
  for (const truth_t& truth : log.truth) {
    if (!stroke.empty() && truth.distance_m < last_distance + kStrokeStep) continue;
    last_distance = truth.distance_m;
    const double speed = std::hypot(truth.vx_mps, truth.vy_mps);
    const int level = static_cast<int>(std::lround((kNumColours - 1) * speed / top));
    stroke.push_back(view({truth.x_m, truth.y_m}));
    if (level == stroke_level) continue;
    svg.Polyline(stroke, "driven", SpeedColour(stroke_level));
    stroke = {stroke.back()};
    stroke_level = level;
  }
  svg.Polyline(stroke, "driven", SpeedColour(stroke_level));
}

void DrawTrueCones(const truth_track_t& track, const View& view, Svg& svg) {
  for (const TrueCone& cone : TrueCones(track)) {
    const double radius = cone.colour == ConeColour::kOrangeLarge ? 4.2 : 3.2;
    svg.Circle(view(cone.position), radius, "rim " + std::string(NameOf(cone.colour)));
  }
  for (const Eigen::Vector2d& thing : Clutter(track)) {
    svg.Rectangle(view(thing) - Eigen::Vector2d(2.5, 2.5), 5.0, 5.0, "clutter", "clutter, no cone");
  }
}

void DrawMappedCones(const RunLog& log, const View& view, Svg& svg) {
  const auto comparison = CompareMap(log);
  if (!comparison) return;
  for (const ComparedCone& cone : comparison->cones) {
    const std::string look =
        "mapped as_" + std::string(NameOf(cone.colour)) + (cone.match ? "" : " wrong");
    svg.Circle(view(cone.position), cone.match ? 5.4 : 8.0, look);
  }
}

void DrawMoment(const track_t& track, const Pose2& T_map_local, const View& view, Svg& svg) {
  const auto draw = [&](const auto& list, const char* look) {
    Points points;
    for (const auto& point : list)
      points.push_back(view(T_map_local * Eigen::Vector2d(point.x_m, point.y_m)));
    svg.Polyline(points, look);
  };
  draw(track.left, "boundary of_left");
  draw(track.right, "boundary of_right");
  std::vector<path_point_t> seen;
  std::copy_if(track.path.begin(), track.path.end(), std::back_inserter(seen),
               [](const auto& p) { return !p.extrapolated; });
  draw(seen, "boundary of_path");
  svg.Circle(view(T_map_local * Eigen::Vector2d(track.x_m, track.y_m)), 4.0, "moment");
}

/// Boundaries and paths of kNumMoments moments, equally far apart on the way.
void DrawMoments(const RunLog& log, const View& view, Svg& svg) {
  const TrueTrajectory trajectory(log);
  const DrivingPhase phase(log);
  const double total = log.truth.empty() ? 0.0 : log.truth.back().distance_m;
  int drawn = 0;
  for (const track_t& track : log.tracks) {
    const auto state = trajectory.At(track.utime);
    if (!state || !track.valid || !phase.IsDriving(track.utime)) continue;
    if (state->distance < total * (drawn + 0.5) / kNumMoments) continue;
    ++drawn;
    DrawMoment(track, state->T_map_base * Pose2{track.x_m, track.y_m, track.yaw_rad}.Inverse(),
               view, svg);
  }
}

void DrawHit(const Eigen::Vector2d& at, double size, Svg& svg) {
  svg.Line(at + Eigen::Vector2d(-size, -size), at + Eigen::Vector2d(size, size), "hit");
  svg.Line(at + Eigen::Vector2d(-size, size), at + Eigen::Vector2d(size, -size), "hit");
}

void DrawOffCourse(const Eigen::Vector2d& at, double size, Svg& svg) {
  const Eigen::Vector2d right(size, 0.0);
  const Eigen::Vector2d down(0.0, size);
  svg.Area({{at - right, at - down, at + right, at + down}}, "off");
}

void DrawMishaps(const RunLog& log, const View& view, Svg& svg) {
  for (size_t i = 1; i < log.truth.size(); ++i) {
    const Eigen::Vector2d at = view({log.truth[i].x_m, log.truth[i].y_m});
    if (log.truth[i].cones_hit > log.truth[i - 1].cones_hit) DrawHit(at, 8.0, svg);
    if (log.truth[i].off_course > log.truth[i - 1].off_course) DrawOffCourse(at, 14.0, svg);
  }
}

void DrawSpeedLegend(double top, Svg& svg) {
  constexpr double kCell = 11.0;
  const double left = kWidth - kSide - kNumColours * kCell;
  for (int level = 0; level < kNumColours; ++level) {
    svg.Rectangle({left + level * kCell, 16.0}, kCell + 0.5, 12.0, "", "", SpeedColour(level));
  }
  svg.Text({left - 8.0, 26.0}, "driven line, speed", "small end");
  svg.Text({left, 42.0}, "0", "faint");
  svg.Text({kWidth - kSide, 42.0}, Fixed(top, 1) + " m/s", "faint end");
}

void DrawScaleBar(const View& view, double y, Svg& svg) {
  const double length = 100.0 * view.scale() < kWidth / 5.0 ? 50.0 : 10.0;
  const double right = kWidth - kSide;
  svg.Line({right - length * view.scale(), y}, {right, y}, "axis");
  for (const double x : {right - length * view.scale(), right})
    svg.Line({x, y - 4.0}, {x, y + 4.0}, "axis");
  svg.Text({right, y - 8.0}, Fixed(length, 0) + " m", "faint end");
}

void DrawLegend(double y, bool race_line, Svg& svg) {
  double x = kSide;
  const auto entry = [&](const char* text, auto&& symbol) {
    symbol(Eigen::Vector2d(x + 6.0, y - 4.0));
    svg.Text({x + 18.0, y}, text, "small");
    x += 32.0 + LegendTextWidth(text);
  };
  entry("cone", [&](const auto& at) { svg.Circle(at, 3.2, "rim blue"); });
  entry("mapped", [&](const auto& at) { svg.Circle(at, 5.4, "mapped as_blue"); });
  entry("mapped, none there",
        [&](const auto& at) { svg.Circle(at, 6.5, "mapped as_unknown wrong"); });
  entry("clutter", [&](const auto& at) {
    svg.Rectangle(at - Eigen::Vector2d(2.5, 2.5), 5.0, 5.0, "clutter");
  });
  entry("boundaries and path as seen from here",
        [&](const auto& at) { svg.Circle(at, 4.0, "moment"); });
  if (race_line) {
    entry("race line", [&](const auto& at) {
      svg.Line(at - Eigen::Vector2d(6.0, 0.0), at + Eigen::Vector2d(6.0, 0.0), "raceline");
    });
  }
  entry("cone hit", [&](const auto& at) { DrawHit(at, 5.0, svg); });
  entry("off course", [&](const auto& at) { DrawOffCourse(at, 7.0, svg); });
}

}  // namespace

std::string Provenance(const nlohmann::json& report) {
  std::string text = "track " + report.at("track").get<std::string>() + ", seed " +
                     report.at("seed").dump() + ", build " + report.at("build").get<std::string>();
  for (const auto& fault : report.at("faults")) text += ", " + fault.get<std::string>();
  return text;
}

Svg DrawTrack(const RunLog& log, const nlohmann::json& report) {
  Points all;
  for (const truth_t& truth : log.truth) all.emplace_back(truth.x_m, truth.y_m);
  if (log.truth_track) {
    for (const TrueCone& cone : TrueCones(*log.truth_track)) all.push_back(cone.position);
  }
  const View view(all);
  Svg svg(kWidth, view.height(), "Track and driven line. " + Provenance(report));
  svg.Text({kSide, 26.0}, "The lap from above", "title");
  svg.Text({kSide, 44.0}, Provenance(report), "faint");
  DrawSpeedLegend(TopSpeed(log), svg);
  if (log.truth_track) DrawAsphalt(*log.truth_track, view, svg);
  DrawDrivenLine(log, view, svg);
  for (const Points& stretch : RaceLineOfALap(log)) svg.Polyline(view(stretch), "raceline");
  DrawMoments(log, view, svg);
  DrawMappedCones(log, view, svg);
  if (log.truth_track) DrawTrueCones(*log.truth_track, view, svg);
  DrawMishaps(log, view, svg);
  DrawScaleBar(view, view.height() - 44.0, svg);  // above the legend
  DrawLegend(view.height() - 18.0, !log.race_lines.empty(), svg);
  return svg;
}

}  // namespace hairpin
