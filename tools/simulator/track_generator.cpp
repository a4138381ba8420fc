#include "tools/simulator/track_generator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tools/simulator/track_checks.hpp"
#include "tools/simulator/track_geometry.hpp"
#include "tools/simulator/track_rounding.hpp"

namespace hairpin {

namespace {

// The rules' bounds, and margins to them.
constexpr double kMinLap = 200.0;
constexpr double kMaxLap = 500.0;
constexpr double kMinRadius = 4.5;   // m of the centre line, before scaling
constexpr double kMaxRadius = 21.0;  // 46 m across outside; the rules allow 50
constexpr double kMinTrackWidth = 3.4;
constexpr double kMaxTrackWidth = 4.2;
constexpr double kBehindStart = 3.0;  // m of straight behind the waiting car
constexpr double kStartToLine = 6.0;  // m
constexpr double kPastLine = 9.0;     // m of straight
constexpr double kStartStraight = kBehindStart + kStartToLine + kPastLine;
constexpr double kGateHalf = 1.25;  // m from the line to its large orange cones
constexpr int kMaxTries = 500;
constexpr int kMaxClutter = 200;

double RoundToMillimetre(double metres) { return std::round(metres * 1000.0) / 1000.0; }

Eigen::Vector2d RoundToMillimetre(const Eigen::Vector2d& point) {
  return {RoundToMillimetre(point.x()), RoundToMillimetre(point.y())};
}

void CheckOptions(const GeneratorOptions& options) {
  if (options.length && !(*options.length >= kMinLap && *options.length <= kMaxLap)) {
    throw std::invalid_argument("length must be from 200 to 500 m");
  }
  if (options.clutter < 0 || options.clutter > kMaxClutter) {
    throw std::invalid_argument("clutter must be from 0 to " + std::to_string(kMaxClutter));
  }
}

TrackOutline OutlineFor(double length, RandomStream& random) {
  constexpr double kClearance = 8.5;   // m between centre lines of neighbouring stretches
  constexpr double kShortening = 0.9;  // of a boundary by shifting and rounding its corners
  OutlineParams params;
  params.min_spacing = random.Uniform(10.5, 13.0);
  params.max_spacing = random.Uniform(15.0, 24.0);
  params.shift = 0.5 * (params.min_spacing - kClearance);
  const double spacing = 0.5 * (params.min_spacing + params.max_spacing);
  params.edges = static_cast<size_t>(std::lround(length / (kShortening * spacing)));
  params.merge = random.Uniform(0.3, 0.9);
  params.shortcut = random.Uniform(0.2, 0.9);
  TrackOutline outline = RandomOutline(params, random);
  if (random.Chance(0.5)) {
    for (Eigen::Vector2d& corner : outline.corners) corner.y() = -corner.y();
  }
  return outline;
}

/// A radius for each corner, such that an edge's two arcs take half of it each, and the start edge
/// keeps its straight. Empty where a corner is too tight.
std::optional<std::vector<double>> RandomRadii(const TrackOutline& outline, RandomStream& random) {
  const size_t n = outline.corners.size();
  const auto share = [&](size_t edge) {
    return 0.5 * (EdgeLength(outline, edge) - (edge == outline.start_edge ? kStartStraight : 0.0));
  };
  std::vector<double> radii;
  for (size_t i = 0; i < n; ++i) {
    const double half_turn = 0.5 * std::abs(TurnAt(outline, i));
    const double room = std::min(share((i + n - 1) % n), share(i)) / std::tan(half_turn);
    if (room < kMinRadius) return std::nullopt;
    const double largest = std::min(room, kMaxRadius);
    radii.push_back(random.Uniform(std::max(kMinRadius, 0.5 * largest), largest));
  }
  return radii;
}

/// A centre line of exactly `length`, by scaling one of about that.
std::optional<RoundedLine> RandomLine(double length, RandomStream& random) {
  constexpr double kMaxScaling = 1.2;
  TrackOutline outline = OutlineFor(length, random);
  auto radii = RandomRadii(outline, random);
  if (!radii) return std::nullopt;
  const auto line = RoundedLine::Make(outline, *radii);
  if (!line) return std::nullopt;
  const double scale = length / line->length();
  if (scale > kMaxScaling || scale < 1.0 / kMaxScaling) return std::nullopt;
  for (Eigen::Vector2d& corner : outline.corners) corner *= scale;
  for (double& radius : *radii) radius *= scale;
  return RoundedLine::Make(outline, *radii);
}

/// Distance to the next cone of a side that bends with `radius`.
double SpacingAt(double radius) { return std::clamp(1.4 + 0.27 * radius, 2.2, 4.6); }

/// The centre line's frame is the outline's; the track's map begins at the waiting car.
struct Layout {
  const RoundedLine& line;
  double gate;  // station of the start line
  double width;
  Pose2 T_map_outline;

  Eigen::Vector2d Beside(double station, double offset) const {
    return RoundToMillimetre(T_map_outline * (line.At(station) * Eigen::Vector2d(0.0, offset)));
  }
};

/// Stations of the cones between the gate's, evenly by the density that the bends of the side ask
/// for.
std::vector<double> ConeStations(const Layout& layout, double offset) {
  constexpr double kStep = 0.05;  // m
  const double begin = layout.gate + kGateHalf;
  const double length = layout.line.length() - 2.0 * kGateHalf;
  const auto steps = static_cast<size_t>(length / kStep);
  const double step = length / static_cast<double>(steps);
  std::vector<double> counts{0.0};  // of spacings up to each step
  for (size_t i = 0; i < steps; ++i) {
    const double curvature = layout.line.Curvature(begin + (static_cast<double>(i) + 0.5) * step);
    const double stretch = 1.0 - curvature * offset;  // of the side against the centre line
    const double radius = curvature == 0.0 ? kMaxLap : stretch / std::abs(curvature);
    counts.push_back(counts.back() + step * stretch / SpacingAt(radius));
  }
  const auto spacings = static_cast<size_t>(std::ceil(counts.back()));
  std::vector<double> stations;
  size_t i = 0;
  for (size_t cone = 1; cone < spacings; ++cone) {
    const double count = counts.back() * static_cast<double>(cone) / static_cast<double>(spacings);
    while (counts[i + 1] < count) ++i;
    const double fraction = (count - counts[i]) / (counts[i + 1] - counts[i]);
    stations.push_back(begin + (static_cast<double>(i) + fraction) * step);
  }
  return stations;
}

std::vector<TrackCone> SideOf(const Layout& layout, double offset, ConeColour colour) {
  std::vector<TrackCone> side{
      {layout.Beside(layout.gate + kGateHalf, offset), ConeColour::kOrangeLarge}};
  for (const double station : ConeStations(layout, offset)) {
    side.push_back({layout.Beside(station, offset), colour});
  }
  side.push_back({layout.Beside(layout.gate - kGateHalf, offset), ConeColour::kOrangeLarge});
  return side;
}

Track TrackAlong(const RoundedLine& line, RandomStream& random) {
  Layout layout{line, 0.0, random.Uniform(kMinTrackWidth, kMaxTrackWidth), {}};
  const double room = std::max(0.0, line.start_straight() - kStartStraight);
  layout.gate = kBehindStart + kStartToLine + random.Uniform(0.0, room);
  layout.T_map_outline = line.At(layout.gate - kStartToLine).Inverse();
  Track track;
  const double half = 0.5 * layout.width;
  track.start_line = {layout.Beside(layout.gate, half), layout.Beside(layout.gate, -half)};
  track.finish_line = track.start_line;
  track.left = SideOf(layout, half, ConeColour::kBlue);
  track.right = SideOf(layout, -half, ConeColour::kYellow);
  return track;
}

/// Things 1.5 to 6 m beside the track, not nearer than 1 m to one another.
void ScatterClutter(Track& track, int count, RandomStream& random) {
  constexpr double kNearest = 1.5;
  constexpr double kFarthest = 6.0;
  constexpr double kApart = 1.0;
  constexpr int kTriesEach = 100;
  const Polyline left = PositionsOf(track.left);
  const Polyline right = PositionsOf(track.right);
  for (int tries = 0; static_cast<int>(track.clutter.size()) < count; ++tries) {
    if (tries == kTriesEach * count) throw std::runtime_error("no room for so much clutter");
    const Polyline& side = random.Chance(0.5) ? left : right;
    const Eigen::Vector2d& foot = side[random.Index(side.size())];
    const double dx = random.Uniform(-kFarthest, kFarthest);
    const double dy = random.Uniform(-kFarthest, kFarthest);
    const Eigen::Vector2d thing = RoundToMillimetre(foot + Eigen::Vector2d(dx, dy));
    const double to_track =
        std::min(Nearest(left, true, thing).distance, Nearest(right, true, thing).distance);
    if (IsOnTrack(track, thing) || to_track < kNearest || to_track > kFarthest) continue;
    const bool free =
        std::none_of(track.clutter.begin(), track.clutter.end(),
                     [&](const Eigen::Vector2d& other) { return (other - thing).norm() < kApart; });
    if (free) track.clutter.push_back(thing);
  }
}

}  // namespace

Track GenerateTrack(const GeneratorOptions& options) {
  CheckOptions(options);
  RandomStream random(options.seed);
  const double length = options.length.value_or(random.Uniform(240.0, 440.0));
  for (int tries = 0; tries < kMaxTries; ++tries) {
    const auto line = RandomLine(length, random);
    if (!line) continue;
    Track track = TrackAlong(*line, random);
    if (FindProblem(track) || !CheckRules(track).empty()) continue;
    ScatterClutter(track, options.clutter, random);
    track.name = "seed " + std::to_string(options.seed);
    return track;
  }
  throw std::runtime_error("no legal track of " + std::to_string(std::lround(length)) + " m in " +
                           std::to_string(kMaxTries) + " tries");
}

Track AccelerationTrack() {
  static constexpr double kLine = 1.7;        // m from the waiting car's centre of gravity
  static constexpr double kLength = 75.0;     // from line to line
  static constexpr double kExit = 100.0;      // behind the finish
  static constexpr double kSpacing = 5.0;     // of a side's cones
  static constexpr double kHalfWidth = 1.75;  // the rules: 3 m wide at least
  static constexpr double kGateHalf = 0.5;    // large cones stand so far before and behind a line
  Track track;
  track.name = "acceleration";
  track.closed = false;
  const double finish = kLine + kLength;
  const auto add = [&track](double x, ConeColour left, ConeColour right) {
    track.left.push_back({RoundToMillimetre({x, kHalfWidth}), left});
    track.right.push_back({RoundToMillimetre({x, -kHalfWidth}), right});
  };
  for (int i = -1; kSpacing * i <= kLength + kExit; ++i) {
    const double x = kLine + kSpacing * i;
    if (x == kLine || x == finish) {
      add(x - kGateHalf, ConeColour::kOrangeLarge, ConeColour::kOrangeLarge);
      add(x + kGateHalf, ConeColour::kOrangeLarge, ConeColour::kOrangeLarge);
    } else if (x < finish) {
      add(x, ConeColour::kBlue, ConeColour::kYellow);
    } else {
      add(x, ConeColour::kOrange, ConeColour::kOrange);
    }
  }
  track.start_line = {{kLine, kHalfWidth}, {kLine, -kHalfWidth}};
  track.finish_line = {{finish, kHalfWidth}, {finish, -kHalfWidth}};
  return track;
}

}  // namespace hairpin
