#include "tools/evaluation/frame_picture.hpp"

#include <sstream>

#include "tools/evaluation/canvas.hpp"

namespace hairpin {
namespace {

constexpr double kRadius = 25.0;  // m about the car
constexpr double kPixelsPerMetre = 20.0;
constexpr double kDrivenAhead = 30.0;  // m

void DrawTrack(Canvas& canvas, const TrackEstimate& estimate) {
  for (const auto& [side, style] :
       {std::pair(&estimate.left, "stroke=\"#1f5fd0\" stroke-width=\"2\""),
        std::pair(&estimate.right, "stroke=\"#e0b000\" stroke-width=\"2\"")}) {
    Polyline line;
    for (const BoundaryPoint& point : *side) line.push_back(point.position);
    canvas.Line(line, style);
  }
  Polyline seen, extrapolated;
  for (const PathPoint& point : estimate.path.points) {
    if (point.extrapolated && extrapolated.empty() && !seen.empty())
      extrapolated.push_back(seen.back());
    (point.extrapolated ? extrapolated : seen).push_back(point.position);
  }
  canvas.Line(seen, "stroke=\"#00a040\" stroke-width=\"3\"");
  canvas.Line(extrapolated, "stroke=\"#00a040\" stroke-width=\"3\" stroke-dasharray=\"6 4\"");
}

std::string Describe(const char* name, const PathScore& score) {
  std::ostringstream text;
  text.precision(3);
  text << name << " posterior " << score.log_posterior() << " = prior " << score.log_prior
       << " (terms";
  for (const double term : score.term) text << ' ' << term;
  text << ") + colour " << score.log_likelihood;
  return text.str();
}

}  // namespace

std::string DrawFrame(const std::vector<RecordedFrame>& run, size_t frame,
                      const PlannerFrame& result) {
  const RecordedTrack track(run);
  const Pose2& T_map_base = run[frame].T_map_base;
  Canvas canvas(T_map_base.position(), kRadius, kPixelsPerMetre);
  for (const Segment& segment : track.boundaries())
    canvas.Line({segment.from, segment.to}, "stroke=\"#d0d0d0\" stroke-width=\"4\"");
  canvas.Line(track.DrivenAhead(frame, kDrivenAhead), "stroke=\"#c080ff\" stroke-width=\"1\"");
  DrawTrack(canvas, result.estimate);
  for (const MapCone& cone : run[frame].cones)
    canvas.Dot(cone.position, 6.0, PaintOf(MostProbable(cone.colour)));
  canvas.Line({T_map_base * Eigen::Vector2d(-1.2, 0.0), T_map_base * Eigen::Vector2d(1.4, 0.0)},
              "stroke=\"red\" stroke-width=\"8\"");
  std::ostringstream title;
  title.precision(3);
  title << "frame " << frame << ", path " << result.estimate.path.length << " m, on cones "
        << result.estimate.path.seen_length << " m; seen stretch " << result.seen_length << " m"
        << (result.crosses ? "; CROSSES" : "") << "; candidates " << result.estimate.num_candidates;
  canvas.Text(1, title.str());
  canvas.Text(2, Describe("winner", result.estimate.winner));
  if (result.estimate.runner_up) canvas.Text(3, Describe("runner-up", *result.estimate.runner_up));
  return canvas.Finish();
}

}  // namespace hairpin
