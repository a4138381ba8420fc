#include "tools/evaluation/lidar_picture.hpp"

#include <sstream>

#include "tools/evaluation/canvas.hpp"

namespace hairpin {
namespace {

const Eigen::Vector2d kCentre(10.0, 0.0);  // base [m]
constexpr double kRadius = 16.0;           // m
constexpr double kPixelsPerMetre = 40.0;

const char* PaintOfHeight(float height) {
  if (height < 0.05f) return "#c8c8c8";
  if (height < 0.35f) return "#f07000";
  return height < 0.55f ? "#b02080" : "#301050";
}

void Cross(Canvas& canvas, const Eigen::Vector2d& at) {
  const Eigen::Vector2d up(0.2, 0.2), down(0.2, -0.2);
  canvas.Line({at - up, at + up}, "stroke=\"red\" stroke-width=\"2\"");
  canvas.Line({at - down, at + down}, "stroke=\"red\" stroke-width=\"2\"");
}

}  // namespace

std::string DrawScan(int64_t number, const PointCloud& cloud, const std::vector<float>& heights,
                     const std::vector<Candidate>& candidates,
                     const std::vector<ScannedCone>& cones,
                     const std::vector<LidarDetection>& detections) {
  Canvas canvas(kCentre, kRadius, kPixelsPerMetre);
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector2d point(static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]));
    canvas.Dot(point, 1.2, PaintOfHeight(heights[i]));
  }
  for (const Candidate& candidate : candidates) {
    if (candidate.verdict != Verdict::kCone)
      canvas.Ring(candidate.position.cast<double>(), 6.0, "stroke=\"#a040ff\"");
  }
  const ScanMatch match = MatchScan(cones, detections);
  for (size_t i = 0; i < cones.size(); ++i) {
    canvas.Dot(cones[i].position, 3.0, PaintOf(cones[i].colour));
    if (match.detection_of_cone[i] < 0 && cones[i].returns >= kFewestReturns)
      Cross(canvas, cones[i].position);
  }
  for (size_t i = 0; i < detections.size(); ++i) {
    canvas.Ring(detections[i].position, 10.0,
                match.cone_of_detection[i] == -1 ? "stroke=\"red\" stroke-width=\"3\""
                                                 : "stroke=\"#00a040\" stroke-width=\"2\"");
  }
  std::ostringstream title;
  title << "scan " << number << ": " << cloud.size() << " points, " << detections.size()
        << " detections, base in the middle of the left side, x to the right, 32 m wide";
  canvas.Text(1, title.str());
  return canvas.Finish();
}

}  // namespace hairpin
