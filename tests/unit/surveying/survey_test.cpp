#include "tools/surveying/survey.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "daemons/gnss_driver/frame_splitter.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/pseudo_terminal.hpp"
#include "tools/surveying/survey_journal.hpp"
#include "tools/surveying/survey_track.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;

constexpr SurveyParams kParams{.averaging_s = 1.0,
                               .min_fixes = 5,
                               .max_scatter_m = 0.03,
                               .max_sigma_m = 0.03,
                               .stale_s = 1.0,
                               .min_spacing_m = 0.4};
const GeodeticPoint kHome{47.3961, 8.6481, 488.0};

/// Someone who walks, with a receiver at 10 Hz.
class Walker {
 public:
  GnssFix FixAt(const Eigen::Vector2d& place, FixType type = FixType::kRtk) {
    now_ += 100'000;
    GnssFix fix;
    fix.utime = now_;
    fix.type = type;
    fix.position = plane_.ToGeodetic({place.x(), place.y(), 0.0});
    fix.position_sigma = {0.012, 0.010, 0.02};
    return fix;
  }
  /// The word said in the end.
  std::string Mark(PointKind kind, const Eigen::Vector2d& place) {
    survey_.Add(FixAt(place), now_);
    std::string word = survey_.Press(kind, now_).word;
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector2d sway(0.005 * (i % 2), -0.005 * (i % 2));
      const SurveyAnswer answer = survey_.Add(FixAt(place + sway), now_);
      if (!answer.word.empty()) word = answer.word;
    }
    return word;
  }
  Survey& survey() { return survey_; }
  int64_t now() const { return now_; }

 private:
  LocalEnu plane_{kHome};
  Survey survey_{kParams};
  int64_t now_ = 1'795'523'719'000'000;
};

TEST(Survey, AveragesFixesOfAStandingAntenna) {
  Walker walker;
  EXPECT_THAT(walker.Mark(PointKind::kBlue, {3.0, 4.0}), HasSubstr("1 blue +- 1 cm"));
  ASSERT_EQ(walker.survey().points().size(), 1U);
  const SurveyedPoint& point = walker.survey().points()[0];
  EXPECT_GE(point.fixes, 11);
  const Eigen::Vector3d enu = LocalEnu(kHome).ToEnu(point.position);
  EXPECT_NEAR(enu.x(), 3.0025, 0.001);
  EXPECT_NEAR(enu.y(), 3.9975, 0.001);
  EXPECT_NEAR(point.sigma.x(), 0.012, 0.001) << "averaging does not make the receiver better";
}

TEST(Survey, RefusesFloatStaleAndMovingFixesWithAWord) {
  Walker walker;
  walker.survey().Add(walker.FixAt({0.0, 0.0}, FixType::kFloat), walker.now());
  EXPECT_THAT(walker.survey().Press(PointKind::kBlue, walker.now()).word, HasSubstr("float"));
  walker.survey().Add(walker.FixAt({0.0, 0.0}), walker.now());
  EXPECT_THAT(walker.survey().Press(PointKind::kBlue, walker.now() + 2'000'000).word,
              HasSubstr("stale"));
  walker.survey().Press(PointKind::kBlue, walker.now());
  EXPECT_THAT(walker.survey().Wait(walker.now() + 2'000'000).word, HasSubstr("silent"));
  walker.survey().Press(PointKind::kBlue, walker.now());
  walker.survey().Add(walker.FixAt({0.0, 0.0}), walker.now());
  EXPECT_THAT(walker.survey().Add(walker.FixAt({0.2, 0.0}), walker.now()).word, HasSubstr("moved"));
  EXPECT_TRUE(walker.survey().points().empty());
}

TEST(Survey, RefusesAConeThatStandsAlreadyAndTakesTheLastOneBack) {
  Walker walker;
  walker.Mark(PointKind::kBlue, {3.0, 4.0});
  EXPECT_THAT(walker.Mark(PointKind::kYellow, {3.2, 4.0}), HasSubstr("doubled: number 1"));
  EXPECT_TRUE(walker.survey().Undo().is_undone);
  EXPECT_THAT(walker.Mark(PointKind::kYellow, {3.2, 4.0}), HasSubstr("1 yellow"));
}

/// Points of a circular lap, walked the wrong way round and one side after the other.
std::vector<std::pair<PointKind, Eigen::Vector2d>> Circle() {
  std::vector<std::pair<PointKind, Eigen::Vector2d>> marks;
  for (const auto& [kind, radius] :
       {std::pair(PointKind::kBlue, 13.0), std::pair(PointKind::kYellow, 17.0)}) {
    for (int i = 23; i >= 0; --i) {
      const double angle = (i + 0.5) * 2.0 * M_PI / 24.0;
      marks.emplace_back(kind, radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  marks.emplace_back(PointKind::kStart, Eigen::Vector2d(15.0, 0.0));
  marks.emplace_back(PointKind::kAhead, Eigen::Vector2d(15.0, 2.0));
  return marks;
}

TEST(SurveyTrack, IsALapInLocalEnuWithItsOriginAndCovariances) {
  Walker walker;
  for (const auto& [kind, place] : Circle()) walker.Mark(kind, place);
  const TemporaryFolder folder;
  const std::string file = folder.File("surveyed.yaml");
  SaveTrack(TrackOf(walker.survey().points(), "circle"), file);
  const Track track = LoadTrack(file);
  ASSERT_TRUE(track.origin);
  EXPECT_NEAR(track.origin->latitude_deg, kHome.latitude_deg, 1e-3);
  EXPECT_EQ(track.left.size(), 24U);
  EXPECT_EQ(track.right.size(), 24U);
  EXPECT_NEAR(track.start.yaw, M_PI_2, 0.01);
  ASSERT_TRUE(track.left[0].covariance);
  EXPECT_NEAR((*track.left[0].covariance)(0, 0), 0.012 * 0.012, 3e-5);
  for (size_t i = 1; i < track.left.size(); ++i) {
    EXPECT_NEAR((track.left[i].position - track.left[i - 1].position).norm(),
                2.0 * 13.0 * std::sin(M_PI / 24.0), 0.02);
  }
}

TEST(SurveyTrack, SaysWhatIsMissing) {
  EXPECT_THROW(TrackOf({}, "empty"), TrackError);
  SurveyedPoint blue;
  blue.position = kHome;
  EXPECT_THROW(TrackOf({blue}, "no start"), TrackError);
}

class Journal : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string file_ = folder_.File("survey.journal");
};

TEST_F(Journal, LosesNothingButTheLineThatWasBeingWritten) {
  SurveyedPoint point;
  point.position = kHome;
  point.sigma = {0.01, 0.02, 0.03};
  point.fixes = 20;
  {
    SurveyJournal journal(file_);
    for (const PointKind kind : {PointKind::kBlue, PointKind::kYellow, PointKind::kStart}) {
      point.kind = kind;
      journal.Append(point);
    }
    journal.AppendUndo();
  }
  std::ofstream(file_, std::ios::app) << R"({"kind":"blue","lat)";  // the battery died
  SurveyJournal journal(file_);
  ASSERT_EQ(journal.points().size(), 2U);
  EXPECT_EQ(journal.points()[1].kind, PointKind::kYellow);
  EXPECT_EQ(journal.points()[1].position.latitude_deg, kHome.latitude_deg);
  EXPECT_EQ(journal.points()[1].sigma, point.sigma);
  journal.Append(point);
  EXPECT_EQ(SurveyJournal(file_).points().size(), 3U) << "goes on behind the last whole line";
}

TEST_F(Journal, RefusesAFileOfSomethingElse) {
  std::ofstream(file_) << "cones: 12\n";
  EXPECT_THROW(SurveyJournal{file_}, std::runtime_error);
}

/// hairpin-survey as a person starts it, with a receiver on a pseudo terminal.
class SurveyTool : public Journal {
 protected:
  void SetUp() override {
    ASSERT_EQ(pipe(keys_.data()), 0);
    tool_ = fork();
    if (tool_ == 0) {
      dup2(keys_[0], STDIN_FILENO);
      close(keys_[1]);
      execl(HAIRPIN_BINARY_DIR "/bin/hairpin-survey", "hairpin-survey", "--port",
            receiver_.path().c_str(), "--out", out_.c_str(), "--journal", file_.c_str(),
            "--config-dir", HAIRPIN_SOURCE_DIR "/config", nullptr);
      _exit(127);
    }
  }
  void TearDown() override {
    if (tool_ > 0) kill(tool_, SIGKILL);
    for (const int descriptor : keys_) close(descriptor);
  }

  static std::string Angle(double degrees, int width) {
    std::array<char, 32> text;
    const double whole = std::floor(degrees);
    std::snprintf(text.data(), text.size(), "%0*d%010.7f", width, static_cast<int>(whole),
                  60.0 * (degrees - whole));
    return text.data();
  }
  void Say(const Eigen::Vector2d& place) {
    const GeodeticPoint point = LocalEnu(kHome).ToGeodetic({place.x(), place.y(), 0.0});
    std::array<char, 48> time;
    std::snprintf(time.data(), time.size(), "%02d%02d%02d.%01d0", 12 + tick_ / 36000,
                  tick_ / 600 % 60, tick_ / 10 % 60, tick_ % 10);
    ++tick_;
    const std::string at = time.data();
    const std::string text =
        NmeaFrame("GNGGA," + at + "," + Angle(point.latitude_deg, 2) + ",N," +
                  Angle(point.longitude_deg, 3) + ",E,4,20,0.6,440.0,M,48.0,M,,") +
        NmeaFrame("GNGST," + at + ",0.01,0.01,0.01,0.0,0.010,0.012,0.020") +
        NmeaFrame("GNRMC," + at + ",A,,,,,0.0,,241126,,,R");
    const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
    ASSERT_GT(receiver_.Write({bytes, text.size()}), 0U);
  }
  /// Presses and stands still until the journal has `points` lines.
  void Mark(char key, const Eigen::Vector2d& place, int lines) {
    for (int i = 0; i < 3; ++i) Say(place);
    WaitUntilHeard();  // or what was said at the place before would count
    ASSERT_EQ(write(keys_[1], &key, 1), 1);
    for (int i = 0; i < 2000 && Lines() < lines; ++i) {
      Say(place);
      WaitUntilHeard();
    }
    ASSERT_EQ(Lines(), lines);
  }
  void WaitUntilHeard() const {
    int tries = 0;
    do {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (receiver_.Unread() > 0 && ++tries < 5000);
  }
  int Lines() const {
    std::ifstream stream(file_);
    int lines = 0;
    for (std::string line; std::getline(stream, line);) ++lines;
    return lines;
  }
  int Quit() {
    EXPECT_EQ(write(keys_[1], "q", 1), 1);
    int status = 0;
    waitpid(tool_, &status, 0);
    tool_ = -1;
    return WEXITSTATUS(status);
  }

  std::string out_ = folder_.File("track.yaml");
  PseudoTerminal receiver_;
  std::array<int, 2> keys_{-1, -1};
  pid_t tool_ = -1;
  int tick_ = 0;
};

TEST_F(SurveyTool, WritesTheTrackThatWasWalked) {
  const std::map<PointKind, char> keys{{PointKind::kBlue, 'b'},
                                       {PointKind::kYellow, 'y'},
                                       {PointKind::kStart, 's'},
                                       {PointKind::kAhead, 'a'}};
  int lines = 0;
  for (const auto& [kind, place] : Circle()) {
    Mark(keys.at(kind), place, ++lines);
    if (HasFatalFailure()) return;
  }
  ASSERT_EQ(Quit(), 0);
  const Track track = LoadTrack(out_);
  ASSERT_TRUE(track.origin);
  const LocalEnu plane(*track.origin);
  const Eigen::Vector2d home = plane.ToEnu(kHome).head<2>();
  for (const TrackCone& cone : track.left) EXPECT_NEAR((cone.position - home).norm(), 13.0, 0.001);
  for (const TrackCone& cone : track.right) EXPECT_NEAR((cone.position - home).norm(), 17.0, 0.001);
}

}  // namespace
}  // namespace hairpin
