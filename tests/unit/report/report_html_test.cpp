#include "tools/report/report_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/report/chart.hpp"
#include "tools/report/run_metrics.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;
using testing::Not;

RunContext Context() {
  RunContext context;
  context.seed = 4;
  context.track = "oval";
  context.build = "0123abcd4567";
  context.real_time_factor = 24.3;
  context.lap = {true, 17.93, 0, 0, 12.0, 9.6, "one lap driven, standing", {17.93}};
  context.latency_ms = {{"local_mapper", {0.2, 0.4, 0.3}},
                        {"boundary_estimator", {0.5, 0.9}},
                        {"end to end", {2.0, 4.5}}};
  return context;
}

RunLog Lap() {
  SyntheticRunParams params;
  params.distance = 190.0;
  params.speed = 12.0;
  params.speed_swing = 5.0;
  params.position_noise = 0.08;
  params.yaw_drift_radps = 0.0005;
  params.fusion_off_s = 8.0;
  params.false_cone = Eigen::Vector2d(40.0, 20.0);
  params.wrong_colour_beyond = 14.0;
  return MakeSyntheticRun(params);
}

std::string Page(const RunLog& log, const RunContext& context) {
  return ReportPage(EvaluateRun(log, context), log);
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Every tag that was opened is closed, in order.
bool IsWellFormed(const std::string& text) {
  std::vector<std::string> open;
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const size_t end = text.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = text.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /\n", 1));
    if (tag.front() == '!' || tag.back() == '/' || name == "meta") continue;
    if (tag.front() != '/') {
      open.push_back(name);
    } else if (open.empty() || "/" + open.back() != tag) {
      return false;
    } else {
      open.pop_back();
    }
  }
  return open.empty();
}

TEST(ReportPage, TellsTheResultAndWhoMadeIt) {
  const std::string page = Page(Lap(), Context());
  EXPECT_THAT(page, HasSubstr("Finished in 17.93 s</h1>"));
  EXPECT_THAT(page, HasSubstr("one lap driven, standing"));
  EXPECT_THAT(page, HasSubstr("LIDAR_AND_CAMERA"));
  size_t pictures = 0;
  for (size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1)) {
    ++pictures;
    EXPECT_NE(page.substr(at, 400).find("track oval, seed 4, build 0123abcd4567"),
              std::string::npos);
  }
  EXPECT_EQ(pictures, 5u);
}

TEST(ReportPage, IsWellFormedAndNeedsNothingElse) {
  const std::string page = Page(Lap(), Context());
  EXPECT_TRUE(IsWellFormed(page));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(ReportPage, SaysWhyALapWasNotFinished) {
  RunContext context = Context();
  context.lap = {};
  context.lap.reason = "stopped: every cone source <dead>";
  const std::string page = Page(Lap(), context);
  EXPECT_THAT(page, HasSubstr("Not finished</h1>"));
  EXPECT_THAT(page, HasSubstr("stopped: every cone source &lt;dead&gt;"));
}

TEST(ReportPage, CountsPenalties) {
  RunContext context = Context();
  context.lap.cones_hit = 3;
  context.lap.off_course = 1;
  EXPECT_THAT(Page(Lap(), context), HasSubstr("Finished in 17.93 s + 16 s of penalties"));
}

TEST(ReportPage, OfAnEmptyLogIsWholeToo) {
  const std::string page = Page({}, {});
  EXPECT_TRUE(IsWellFormed(page));
  EXPECT_THAT(page, HasSubstr("Not finished"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(TrackPicture, MarksWhereConesWereHitAndTheCourseWasLeft) {
  RunLog log = Lap();
  const auto count = [](const std::string& page, const std::string& look) {
    size_t found = 0;
    for (size_t at = page.find(look); at != std::string::npos; at = page.find(look, at + 1))
      ++found;
    return found;
  };
  const std::string clean = Page(log, Context());
  for (size_t i = 500; i < log.truth.size(); ++i) log.truth[i].cones_hit = i < 900 ? 1 : 2;
  for (size_t i = 700; i < log.truth.size(); ++i) log.truth[i].off_course = 1;
  const std::string page = Page(log, Context());
  EXPECT_EQ(count(page, "class=\"hit\""), count(clean, "class=\"hit\"") + 2 * 2);
  EXPECT_EQ(count(page, "class=\"off\""), count(clean, "class=\"off\"") + 1);
}

TEST(WriteReport, WritesPageFiguresAndPictures) {
  const TemporaryFolder folder;
  const std::string directory = folder.path();
  const RunLog log = Lap();
  const auto report = EvaluateRun(log, Context());
  WriteReport(directory, report, log);
  EXPECT_EQ(nlohmann::json::parse(ReadFile(directory + "/report.json")), report);
  EXPECT_EQ(ReadFile(directory + "/report.html"), ReportPage(report, log));
  for (const char* name : {"track", "speed", "lateral_error", "path_length", "out_of_track"}) {
    const std::string picture = ReadFile(directory + "/" + name + ".svg");
    EXPECT_TRUE(IsWellFormed(picture)) << name;
    EXPECT_THAT(picture, HasSubstr("<style>")) << name;
  }
}

TEST(WriteReport, SaysThatAFolderIsNotThere) {
  EXPECT_THROW(WriteReport("/nonexistent", EvaluateRun({}, {}), {}), std::runtime_error);
}

TEST(NiceTicks, AreRoundAndWithinTheRange) {
  EXPECT_EQ(NiceTicks({0.0, 12.0}, 6), (std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0}));
  EXPECT_EQ(NiceTicks({0.0, 100.0}, 6), (std::vector<double>{0.0, 20.0, 40.0, 60.0, 80.0, 100.0}));
  EXPECT_EQ(NiceTicks({-0.3, 0.3}, 6).size(), 7u);
  EXPECT_TRUE(NiceTicks({1.0, 1.0}, 6).empty());
}

}  // namespace
}  // namespace hairpin
