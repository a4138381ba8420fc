#include <algorithm>
#include <array>

#include "tools/report/chart.hpp"
#include "tools/report/paper_figures.hpp"
#include "tools/report/path_metrics.hpp"
#include "tools/report/pictures.hpp"

namespace hairpin {
namespace {

constexpr double kWidth = 510.0;
constexpr double kHeight = 300.0;
constexpr double kBarWidth = 0.4;

/// All zero where the run measured none.
PathHistogram Ours(const nlohmann::json& report, const char* key) {
  const auto& list = report.at("path").at(key);
  return list.is_null() ? PathHistogram{} : list.get<PathHistogram>();
}

Svg DrawHistogram(const ChartText& text, double top, const PathHistogram& ours,
                  const PathHistogram& theirs) {
  Chart chart(kWidth, kHeight, text, {-0.6, kNumPathMetres - 0.4}, {0.0, top});
  for (int metre = 0; metre < kNumPathMetres; ++metre) {
    const auto i = static_cast<size_t>(metre);
    const std::string at = " % at " + std::to_string(metre) + " m";
    chart.Bar(metre - kBarWidth, kBarWidth, ours[i], "bar-ours",
              "this run: " + Fixed(ours[i], 2) + at);
    chart.Bar(metre, kBarWidth, theirs[i], "bar-theirs", "paper: " + Fixed(theirs[i], 2) + at);
    chart.LabelBelow(metre, std::to_string(metre));
  }
  chart.Legend({{"this run", "bar-ours", false}, {"paper, FSG 2019", "bar-theirs", false}});
  return chart.svg();
}

}  // namespace

Svg DrawPathLengths(const nlohmann::json& report) {
  const ChartText text{"Length of paths", Provenance(report),
                       "seen length [m], last: 15 m and more", "paths [%]"};
  return DrawHistogram(text, 100.0, Ours(report, "length_percent"), paper::kLengthPercent);
}

Svg DrawOutOfTrack(const nlohmann::json& report) {
  const PathHistogram ours = Ours(report, "out_of_track_percent");
  const double highest = std::max(
      *std::max_element(ours.begin(), ours.end()),
      *std::max_element(paper::kOutOfTrackPercent.begin(), paper::kOutOfTrackPercent.end()));
  const ChartText text{"Paths leaving the track", Provenance(report),
                       "first point outside, along the path [m]", "paths [%]"};
  return DrawHistogram(text, 1.15 * highest, ours, paper::kOutOfTrackPercent);
}

}  // namespace hairpin
