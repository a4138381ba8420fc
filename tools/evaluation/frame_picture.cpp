#include "tools/evaluation/frame_picture.hpp"

#include <sstream>

namespace hairpin {
namespace {

constexpr double kRadius = 25.0;  // m about the car
constexpr double kPixelsPerMetre = 20.0;
constexpr double kDrivenAhead = 30.0;  // m

const char* PaintOf(ConeColour colour) {
  switch (colour) {
    case ConeColour::kBlue:
      return "#1f5fd0";
    case ConeColour::kYellow:
      return "#e0b000";
    case ConeColour::kOrange:
    case ConeColour::kOrangeLarge:
      return "#f07000";
    case ConeColour::kUnknown:
      break;
  }
  return "#808080";
}

/// Metres about the car, y up, onto the picture.
class Canvas {
 public:
  explicit Canvas(const Eigen::Vector2d& centre) : centre_(centre) {
    const double size = 2.0 * kRadius * kPixelsPerMetre;
    svg_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << size << "\" height=\"" << size
         << "\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  }

  void Line(const Polyline& line, const char* style) {
    svg_ << "<polyline fill=\"none\" " << style << " points=\"";
    for (const Eigen::Vector2d& point : line) svg_ << X(point) << ',' << Y(point) << ' ';
    svg_ << "\"/>\n";
  }

  void Dot(const Eigen::Vector2d& point, double radius_px, const char* paint) {
    svg_ << "<circle cx=\"" << X(point) << "\" cy=\"" << Y(point) << "\" r=\"" << radius_px
         << "\" fill=\"" << paint << "\"/>\n";
  }

  void Text(double line, const std::string& text) {
    svg_ << "<text x=\"10\" y=\"" << 20.0 * line << "\" font-family=\"monospace\" font-size=\"14\">"
         << text << "</text>\n";
  }

  std::string Finish() {
    svg_ << "</svg>\n";
    return svg_.str();
  }

 private:
  double X(const Eigen::Vector2d& point) const {
    return kPixelsPerMetre * (kRadius + point.x() - centre_.x());
  }
  double Y(const Eigen::Vector2d& point) const {
    return kPixelsPerMetre * (kRadius - point.y() + centre_.y());
  }

  Eigen::Vector2d centre_;
  std::ostringstream svg_;
};

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
  Canvas canvas(T_map_base.position());
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
