#include "daemons/global_mapper/race_line/corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/require.hpp"

namespace hairpin {
namespace {

constexpr size_t kLeft = 0;
constexpr size_t kRight = 1;
constexpr double kNear = 8.0;           // m: what lies farther off bounds nothing at a place
constexpr double kStep = 0.05;          // m, of the search for room
constexpr double kFarthestOut = 1.0;    // m, beyond what its neighbours say
constexpr double kSharpest = 0.45;      // 1/m: no car here turns in less than 2.2 m
constexpr double kMaxClosingGap = 3.0;  // m

struct SideCone {
  double s;
  double off;  // from the driven line, positive
  Eigen::Vector2d position;
};

void Check(const CorridorParams& params) {
  constexpr Require require("Corridor");
  require(params.spacing > 0.0, "spacing_m must be > 0");
  require(params.smoothing_length >= 0.0, "smoothing_length_m must be >= 0");
  require(params.max_half_width > 0.0, "max_half_width_m must be > 0");
  require(params.clearance >= 0.0, "clearance_m must be >= 0");
}

bool BelongsTo(size_t side, ConeColour colour) {
  if (colour == ConeColour::kBlue) return side == kLeft;
  if (colour == ConeColour::kYellow) return side == kRight;
  return true;
}

// What the neighbours say at `s` between them; s rises round the lap.
double Between(const SideCone& before, const SideCone& after, double s, double length) {
  const auto ahead = [length](double from, double to) {
    return to >= from ? to - from : to - from + length;
  };
  const double span = ahead(before.s, after.s);
  const double t = span > 0.0 ? ahead(before.s, s) / span : 0.5;
  return (1.0 - t) * before.off + t * after.off;
}

std::vector<SideCone> ConesOfSide(const std::vector<MappedCone>& cones, size_t side,
                                  const ClosedCurve& driven, double max_half_width) {
  std::vector<SideCone> chosen;
  for (const MappedCone& cone : cones) {
    const ClosedCurve::Place place = driven.Nearest(cone.position);
    const bool is_left = place.lateral > 0.0;
    if (is_left != (side == kLeft) || place.distance > max_half_width) continue;
    if (BelongsTo(side, cone.colour)) chosen.push_back({place.s, place.distance, cone.position});
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const SideCone& a, const SideCone& b) { return a.s < b.s; });
  // The farthest out goes first, until all agree: then it cannot speak for its neighbours.
  while (chosen.size() > 3) {
    size_t worst = 0;
    double most = kFarthestOut;
    for (size_t i = 0; i < chosen.size(); ++i) {
      const SideCone& before = chosen[(i + chosen.size() - 1) % chosen.size()];
      const SideCone& after = chosen[(i + 1) % chosen.size()];
      const double out = chosen[i].off - Between(before, after, chosen[i].s, driven.length());
      if (out <= most) continue;
      most = out;
      worst = i;
    }
    if (most <= kFarthestOut) break;
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return chosen;
}

double DistanceTo(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                  const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = to - from;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (from + t * along - point).norm();
}

// A drive that ends a little before its beginning, and leads there.
bool EndsBehindItsBeginning(const Points& poses, const std::vector<double>& driven,
                            double min_lap) {
  constexpr double kMaxWay = 25.0;        // m
  constexpr double kCosineOfAngle = 0.7;  // between that way and the drive's two ends
  if (poses.size() < 3 || driven.back() < min_lap) return false;
  const Eigen::Vector2d way = poses.front() - poses.back();
  const Eigen::Vector2d first = (poses[1] - poses[0]).normalized();
  const Eigen::Vector2d last = (poses.back() - poses[poses.size() - 2]).normalized();
  const double least = kCosineOfAngle * way.norm();
  return way.norm() <= kMaxWay && way.dot(first) >= least && way.dot(last) >= least;
}

}  // namespace

SweptWidth SweptBy(const Car& car, double curvature) {
  const double k = std::min(std::abs(curvature), kSharpest);
  const double half = 0.5 * car.body_width;
  if (k < 1e-6) return {half, half};
  const double radius = 1.0 / k;
  const double rear = std::sqrt(radius * radius - car.rear_axle * car.rear_axle);
  const double nose = car.rear_axle + car.front_overhang;
  return {radius - (rear - half), std::hypot(rear + half, nose) - radius};
}

Points LapOf(const Points& poses, double min_lap) {
  // Of all pairs of a place in the first stretch and one a lap later, the one with the least gap.
  constexpr double kFirstStretch = 40.0;
  std::vector<double> driven(poses.size(), 0.0);
  for (size_t i = 1; i < poses.size(); ++i)
    driven[i] = driven[i - 1] + (poses[i] - poses[i - 1]).norm();
  double least = kMaxClosingGap;
  size_t first = 0;
  size_t last = 0;
  for (size_t i = 0; i < poses.size() && driven[i] < kFirstStretch; ++i) {
    for (size_t j = i + 1; j < poses.size(); ++j) {
      if (driven[j] - driven[i] < min_lap) continue;
      const double gap = (poses[i] - poses[j]).norm();
      if (gap >= least) continue;
      least = gap;
      first = i;
      last = j;
    }
  }
  if (last == 0 && EndsBehindItsBeginning(poses, driven, min_lap)) return poses;
  if (last == 0)
    throw std::invalid_argument("LapOf: the drive does not come back to its beginning");
  const Eigen::Vector2d gap = poses[first] - poses[last];
  Points lap;
  for (size_t i = first; i < last; ++i) {
    const double share = (driven[i] - driven[first]) / (driven[last] - driven[first]);
    lap.push_back(poses[i] + share * gap);
  }
  return lap;
}

Corridor::Corridor(const std::vector<MappedCone>& cones, const Points& driven, const Car& car,
                   const CorridorParams& params)
    : car_(car), params_(params) {
  Check(params);
  const ClosedCurve rough(driven, params.spacing);
  const ClosedCurve line(Smoothed(rough, params.smoothing_length), params.spacing);
  std::array<std::vector<SideCone>, 2> sides;
  for (const size_t side : {kLeft, kRight}) {
    sides[side] = ConesOfSide(cones, side, line, params.max_half_width);
    if (sides[side].size() < 3) throw std::invalid_argument("Corridor: too few cones on a side");
    const double sign = side == kLeft ? 1.0 : -1.0;
    for (size_t i = 0; i < sides[side].size(); ++i) {
      const SideCone& from = sides[side][i];
      const SideCone& to = sides[side][(i + 1) % sides[side].size()];
      sides_[side].push_back(from.position);
      segments_[side].push_back({from.position, to.position});
      const double span = to.s > from.s ? to.s - from.s : to.s - from.s + line.length();
      Eigen::Vector2d before = from.position;
      const int steps = static_cast<int>(std::ceil(span / params.spacing));
      for (int k = 1; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        const Eigen::Vector2d here =
            k == steps ? to.position
                       : line.At(from.s + t * span, sign * std::lerp(from.off, to.off, t));
        segments_[side].push_back({before, here});
        before = here;
      }
    }
  }
  for (const MappedCone& cone : cones) {
    const size_t side = line.Nearest(cone.position).lateral > 0.0 ? kLeft : kRight;
    segments_[side].push_back({cone.position, cone.position});
  }
  Points middle;
  for (size_t i = 0; i < line.size(); ++i) {
    const auto way = FreeWay(line.points()[i]);
    middle.push_back(line.points()[i] + 0.5 * (way[kLeft] - way[kRight]) * line.normal(i));
  }
  centre_.emplace(Smoothed(ClosedCurve(middle, params.spacing), params.smoothing_length),
                  params.spacing);
}

Corridor::Segments Corridor::NearSegments(const Eigen::Vector2d& point, size_t side) const {
  Segments near;
  for (const Segment& segment : segments_[side]) {
    if (DistanceTo(segment.from, segment.to, point) < kNear) near.push_back(segment);
  }
  return near;
}

std::array<double, 2> Corridor::FreeWay(const Eigen::Vector2d& point) const {
  std::array<double, 2> way{kNear, kNear};
  for (const size_t side : {kLeft, kRight}) {
    for (const Segment& segment : segments_[side])
      way[side] = std::min(way[side], DistanceTo(segment.from, segment.to, point));
  }
  return way;
}

Corridor::Room Corridor::RoomAt(const Eigen::Vector2d& point, const Eigen::Vector2d& normal,
                                double curvature) const {
  const SweptWidth swept = SweptBy(car_, curvature);
  std::array<double, 2> room{};
  for (const size_t side : {kLeft, kRight}) {
    const bool inner = (side == kLeft) == (curvature > 0.0);
    const double wanted = (inner ? swept.inner : swept.outer) + params_.clearance;
    const Segments segments = NearSegments(point, side);
    const auto is_free = [&](double off) {
      const Eigen::Vector2d place = point + off * normal;
      return std::all_of(segments.begin(), segments.end(), [&](const Segment& segment) {
        return DistanceTo(segment.from, segment.to, place) >= wanted;
      });
    };
    const double outward = side == kLeft ? kStep : -kStep;
    double off = 0.0;
    const int most = static_cast<int>(kNear / kStep);
    if (is_free(0.0)) {
      for (int i = 0; i < most && is_free(off + outward); ++i) off += outward;
    } else {
      for (int i = 0; i < most && !is_free(off); ++i) off -= outward;
    }
    room[side] = off;
  }
  if (room[kRight] > room[kLeft]) room[kLeft] = room[kRight] = 0.5 * (room[kLeft] + room[kRight]);
  return {room[kRight], room[kLeft]};
}

}  // namespace hairpin
