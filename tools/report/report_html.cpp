#include "tools/report/report_html.hpp"

#include <fstream>
#include <optional>
#include <stdexcept>

#include "tools/report/local_map_metrics.hpp"
#include "tools/report/paper_figures.hpp"
#include "tools/report/pictures.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

// Penalties of the rules for autocross and trackdrive.
constexpr double kSecondsPerCone = 2.0;
constexpr double kSecondsPerOffCourse = 10.0;

const char* const kPageStyle = R"(
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1100px; padding: 24px 20px 48px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; -webkit-print-color-adjust: exact; print-color-adjust: exact; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 32px 0 10px; }
p { margin: 6px 0; } .faint, .note { color: var(--faint); } .note { font-size: 13px; }
.verdict { border-left: 6px solid; padding: 2px 0 2px 16px; margin-bottom: 20px; }
.verdict.good { border-color: var(--good); } .verdict.fair { border-color: var(--fair); } .verdict.bad { border-color: var(--bad); }
.good h1 { color: var(--good); } .fair h1 { color: var(--fair); } .bad h1 { color: var(--bad); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 10px; margin: 0 0 20px; }
.tile { background: var(--card); border-radius: 8px; padding: 10px 14px; }
.tile b { display: block; font-size: 24px; line-height: 1.25; font-weight: 650; font-variant-numeric: tabular-nums; }
.tile span { font-size: 13px; color: var(--faint); }
svg.picture { display: block; width: 100%; height: auto; border-radius: 8px; margin: 10px 0; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 0 14px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 5px 10px; border-bottom: 1px solid var(--rule); }
th { font-weight: 600; font-size: 13px; color: var(--faint); }
th:first-child, td:first-child, td.text, th.text { text-align: left; }
td.good { color: var(--good); font-weight: 600; } td.bad { color: var(--bad); font-weight: 600; }
@media (max-width: 720px) { .pair { grid-template-columns: 1fr; } }
@media print { body { max-width: none; padding: 0; } h2 { break-after: avoid; } svg.picture, table, .tiles { break-inside: avoid; } }
)";

std::optional<double> NumberAt(const json& report, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!report.contains(place) || !report.at(place).is_number()) return std::nullopt;
  return report.at(place).get<double>();
}

std::string TextOf(const std::optional<double>& value, int digits, const std::string& unit = "") {
  return value ? Fixed(*value, digits) + (unit.empty() ? "" : " " + unit) : "–";
}

std::string Figure(const json& report, const std::string& pointer, int digits,
                   const std::string& unit = "") {
  return TextOf(NumberAt(report, pointer), digits, unit);
}

std::string Tile(const std::string& value, const std::string& label) {
  return "<div class=\"tile\"><b>" + Escaped(value) + "</b><span>" + Escaped(label) +
         "</span></div>\n";
}

struct Cell {
  std::string text;
  std::string look;  // class of the cell
};

std::string Row(const std::vector<Cell>& cells, const char* tag = "td") {
  std::string row = "<tr>";
  for (const Cell& cell : cells) {
    row += std::string("<") + tag + (cell.look.empty() ? "" : " class=\"" + cell.look + "\"") +
           ">" + Escaped(cell.text) + "</" + tag + ">";
  }
  return row + "</tr>\n";
}

std::string Table(const std::vector<Cell>& head, const std::string& rows) {
  return "<table>\n" + Row(head, "th") + rows + "</table>\n";
}

std::string Verdict(const json& report) {
  const json& lap = report.at("lap");
  const double penalty = kSecondsPerCone * lap.at("cones_hit").get<int>() +
                         kSecondsPerOffCourse * lap.at("off_course").get<int>();
  std::string look = "bad";
  std::string headline = "Not finished";
  if (lap.at("finished").get<bool>()) {
    look = penalty > 0.0 ? "fair" : "good";
    headline = "Finished in " + Figure(report, "/lap/time_s", 2, "s");
    if (penalty > 0.0) headline += " + " + Fixed(penalty, 0) + " s of penalties";
  }
  return "<header class=\"verdict " + look + "\"><h1>" + Escaped(headline) + "</h1>\n<p>" +
         Escaped(lap.at("reason").get<std::string>()) + "</p>\n<p class=\"faint\">" +
         Escaped(Provenance(report)) + "</p></header>\n";
}

std::string Tiles(const json& report) {
  std::string tiles =
      Tile(Figure(report, "/lap/time_s", 2, "s"), "driven time, without penalties") +
      Tile(Figure(report, "/lap/cones_hit", 0), "cones hit") +
      Tile(Figure(report, "/lap/off_course", 0), "times off course") +
      Tile(Figure(report, "/lap/max_speed_mps", 1, "m/s"), "highest speed") +
      Tile(Figure(report, "/lap/mean_speed_mps", 1, "m/s"), "mean speed") +
      Tile(Figure(report, "/real_time_factor", 1, "×"), "of real time");
  const json& laps = report.at("lap").at("lap_times_s");
  for (size_t i = 0; laps.size() > 1 && i < laps.size(); ++i) {
    tiles += Tile(Fixed(laps[i].get<double>(), 2) + " s", "lap " + std::to_string(i + 1));
  }
  return "<section class=\"tiles\">\n" + tiles + "</section>\n";
}

std::string LapSection(const json& report) {
  const json& laps = report.at("lap").at("lap_times_s");
  std::string rows;
  const auto autocross = NumberAt(report, "/autocross/lap/time_s");
  if (autocross) {
    rows += Row({{"autocross, on sight", ""},
                 {Figure(report, "/autocross/lap/time_s", 2), ""},
                 {Figure(report, "/autocross/lap/mean_speed_mps", 2), ""},
                 {Figure(report, "/autocross/lap/cones_hit", 0), ""}});
  }
  for (size_t i = 0; i < laps.size(); ++i)
    rows += Row({{"lap " + std::to_string(i + 1), ""}, {Fixed(laps[i].get<double>(), 2), ""}});
  rows += Row({{"all laps", ""},
               {Figure(report, "/lap/time_s", 2), ""},
               {Figure(report, "/lap/mean_speed_mps", 2), ""},
               {Figure(report, "/lap/cones_hit", 0), ""}});
  std::string notes;
  if (report.contains("speed_ratio")) {
    notes += "<p>Mean speed " + Figure(report, "/speed_ratio", 2) +
             " times that of the autocross lap.</p>\n";
  }
  if (NumberAt(report, "/race_line/followed_percent")) {
    notes += "<p>" + Figure(report, "/race_line/followed_percent", 1, "%") +
             " of the commands followed the race line, which was left " +
             Figure(report, "/race_line/times_left", 0) + " times; " +
             Figure(report, "/race_line/lateral_error_m/rms", 3, "m") +
             " RMS from it, localisation " +
             Figure(report, "/race_line/localisation_m/rms", 3, "m") + ".</p>\n";
  }
  if (laps.size() < 2 && notes.empty()) return "";
  return "<h2>Laps</h2>\n" +
         Table({{"", ""}, {"time [s]", ""}, {"mean speed [m/s]", ""}, {"cones hit", ""}}, rows) +
         notes;
}

std::string PathSection(const json& report) {
  const double full = paper::kLengthPercent.back();
  return "<h2>Paths</h2>\n<div class=\"pair\">" + DrawPathLengths(report).Inline() +
         DrawOutOfTrack(report).Inline() + "</div>\n<p>" +
         Figure(report, "/path/full_length_percent", 1, "%") + " of " +
         Figure(report, "/path/count", 0) + " paths reach 15 m (paper: " + Fixed(full, 1) +
         " %); " + Figure(report, "/path/invalid", 0) +
         " times there was no path.</p>\n<p class=\"note\">Judged while driving, by the part of "
         "each path that seen cones "
         "support, against the true track.</p>\n";
}

std::string Judged(const std::optional<double>& ours, double theirs, bool more_is_better) {
  if (!ours) return "";
  return (more_is_better ? *ours >= theirs : *ours <= theirs) ? "good" : "bad";
}

std::string MapSection(const json& report) {
  const auto rmse = NumberAt(report, "/map/rmse_m");
  const auto lifetime = NumberAt(report, "/false_positive_lifetime_s/max");
  std::string rows =
      Row({{"RMSE of mapped cones", ""},
           {TextOf(rmse, 3, "m"), Judged(rmse, paper::kMapRmse, false)},
           {"0.29 m at 12 m/s", ""}}) +
      Row({{"worst mapped cone", ""}, {Figure(report, "/map/worst_m", 3, "m"), ""}, {"", ""}}) +
      Row({{"true cones mapped / missed", ""},
           {Figure(report, "/map/matched", 0) + " / " + Figure(report, "/map/missed", 0), ""},
           {"", ""}}) +
      Row({{"mapped where no cone is", ""}, {Figure(report, "/map/false", 0), ""}, {"", ""}}) +
      Row({{"mapped again on return", ""}, {Figure(report, "/map/doubled", 0), ""}, {"", ""}}) +
      Row({{"drift of dead reckoning at the end", ""},
           {Figure(report, "/drift/end_m", 2, "m"), ""},
           {"", ""}}) +
      Row({{"longest life of a certain false positive", ""},
           {TextOf(lifetime, 2, "s"), ""},
           {"< " + Fixed(paper::kFalsePositiveLifetime, 1) + " s once unseen", ""}});
  return "<h2>Map</h2>\n" + Table({{"", ""}, {"this run", ""}, {"paper", ""}}, rows) +
         "<p class=\"note\">Every cone the local map held for certain, under one rigid alignment "
         "for the whole run.</p>\n";
}

std::string ColourSection(const json& report) {
  std::vector<Cell> head{{"distance [m]", ""}};
  std::vector<Cell> ours{{"this run", ""}};
  std::vector<Cell> theirs{{"paper", ""}};
  std::vector<Cell> counts{{"cones judged", ""}};
  double from = 0.0;
  for (size_t bin = 0; bin < kColourBinEnds.size(); ++bin) {
    const std::string index = std::to_string(bin);
    const auto accuracy = NumberAt(report, "/colour/accuracy/" + index);
    head.push_back({Fixed(from, 1) + "–" + Fixed(kColourBinEnds[bin], 1), ""});
    // The paper gives two digits.
    ours.push_back(
        {TextOf(accuracy, 3), Judged(accuracy, paper::kColourAccuracy[bin] - 0.005, true)});
    theirs.push_back({Fixed(paper::kColourAccuracy[bin], 2), ""});
    counts.push_back({Figure(report, "/colour/count/" + index, 0), ""});
    from = kColourBinEnds[bin];
  }
  return "<h2>Colours of the local map, share that is right</h2>\n" +
         Table(head, Row(ours) + Row(theirs) + Row(counts));
}

std::string TimingSection(const json& report) {
  std::string rows;
  const auto row = [&](const std::string& name, const std::string& pointer) {
    rows += Row({{name, ""},
                 {Figure(report, pointer + "/p50", 2), ""},
                 {Figure(report, pointer + "/p99", 2), ""},
                 {Figure(report, pointer + "/max", 2), ""}});
  };
  for (const auto& [stage, figures] : report.at("latency_ms").items())
    row(stage, (json::json_pointer("/latency_ms") / stage).to_string());
  row("age of the path that a command follows (data time)", "/data_age_ms");
  return "<h2>Latency [ms]</h2>\n" +
         Table({{"stage", ""}, {"median", ""}, {"99 %", ""}, {"max", ""}}, rows);
}

std::string ModeSection(const json& report) {
  std::string rows;
  for (const json& change : report.at("modes")) {
    rows += Row({{Figure(change, "/t_s", 2), ""},
                 {change.at("mode").get<std::string>(), "text"},
                 {Figure(change, "/reaction_s", 3), ""},
                 {change.at("cause").get<std::string>(), "text"}});
  }
  return "<h2>Map modes</h2>\n" + Table({{"since Go [s]", ""},
                                         {"mode", "text"},
                                         {"after silence of [s]", ""},
                                         {"cause", "text"}},
                                        rows);
}

std::string EstimateSection(const json& report) {
  const std::string rows =
      Row({{"forward velocity", ""}, {Figure(report, "/velocity/vx_rms_mps", 3, "m/s"), ""}}) +
      Row({{"lateral velocity", ""}, {Figure(report, "/velocity/vy_rms_mps", 3, "m/s"), ""}}) +
      Row({{"yaw rate", ""}, {Figure(report, "/velocity/yaw_rate_rms_radps", 4, "rad/s"), ""}}) +
      Row({{"distance from the path", ""}, {Figure(report, "/lateral_error_m/rms", 3, "m"), ""}});
  const std::string log = Figure(report, "/log/events", 0) + " events, " +
                          Figure(report, "/log/undecodable", 0) + " undecodable, " +
                          Figure(report, "/log/skipped_bytes", 0) + " bytes corrupt, " +
                          Figure(report, "/log/over_limit", 0) + " left out for size";
  return "<h2>Errors of estimation and control, RMS while driving</h2>\n" +
         Table({{"", ""}, {"this run", ""}}, rows) + "<p class=\"note\">Log: " + log + ".</p>\n";
}

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

std::string ReportPage(const json& report, const RunLog& log) {
  const std::string title = Escaped("hairpin: " + Provenance(report));
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title + "</title>\n<style>" + kPictureStyle + kPageStyle + "</style>\n</head>\n<body>\n" +
         Verdict(report) + Tiles(report) + DrawTrack(log, report).Inline() + LapSection(report) +
         DrawSpeed(log, report).Inline() + DrawLateralError(log, report).Inline() +
         PathSection(report) + MapSection(report) + ColourSection(report) + TimingSection(report) +
         ModeSection(report) + EstimateSection(report) + "</body>\n</html>\n";
}

void WriteReport(const std::string& out_dir, const json& report, const RunLog& log) {
  WriteFile(out_dir + "/report.json", report.dump(2) + "\n");
  WriteFile(out_dir + "/report.html", ReportPage(report, log));
  WriteFile(out_dir + "/track.svg", DrawTrack(log, report).Standalone());
  WriteFile(out_dir + "/speed.svg", DrawSpeed(log, report).Standalone());
  WriteFile(out_dir + "/lateral_error.svg", DrawLateralError(log, report).Standalone());
  WriteFile(out_dir + "/path_length.svg", DrawPathLengths(report).Standalone());
  WriteFile(out_dir + "/out_of_track.svg", DrawOutOfTrack(report).Standalone());
}

}  // namespace hairpin
