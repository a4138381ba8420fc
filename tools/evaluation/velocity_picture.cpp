#include "tools/evaluation/velocity_picture.hpp"

#include "tools/report/svg.hpp"
#include "tools/report/view.hpp"

namespace hairpin {
namespace {

constexpr int64_t kStep = 50'000;  // us between points of a line

using Points = std::vector<Eigen::Vector2d>;

Points LineOf(const DeadReckoning& run, const Drive& drive, const Pose2& T_enu_local,
              const Eigen::Vector2d& antenna) {
  Points line;
  int64_t next = drive.from;
  for (const DeadReckoned& step : run) {
    if (step.estimate.utime < next || step.estimate.utime > drive.to) continue;
    line.push_back(T_enu_local * (step.T_local_base * antenna));
    next = step.estimate.utime + kStep;
  }
  return line;
}

}  // namespace

std::string DrawVelocityReport(const VelocityReport& report, const Car& car) {
  Points fixes;
  for (const GpsFix& fix : report.recording.gps) {
    if (report.drive.Holds(fix.utime)) fixes.push_back(fix.position);
  }
  const View view(fixes);
  Svg svg(View::kWidth, view.height(), "dead reckoning against GPS");
  for (const Eigen::Vector2d& fix : fixes) svg.Circle(view(fix), 2.5, "clutter");
  const auto draw = [&](const DeadReckoning& run, const char* look) {
    const auto comparison = ComparePosition(run, report.recording, report.drive, car);
    if (!comparison) return std::string("not known");
    svg.Polyline(view(LineOf(run, report.drive, comparison->T_enu_local, car.gnss_position)), look);
    return Fixed(comparison->rms_m, 2) + " m RMS";
  };
  const std::string without = draw(report.without_optical, "target");
  const std::string all = draw(report.run, "ours");
  svg.Text({View::kSide, 22.0}, "Dead reckoning against GPS (circles)", "title");
  svg.Text({View::kSide, 40.0},
           "all sensors: " + all + " (line); without the optical sensor: " + without + " (dashed)",
           "faint");
  return svg.Standalone();
}

}  // namespace hairpin
