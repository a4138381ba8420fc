// A terminal tool for the hand-held RTK receiver: one key for each cone.

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <map>

#include "common/clock.hpp"
#include "common/program.hpp"
#include "daemons/gnss_driver/gnss_driver_node.hpp"
#include "daemons/gnss_driver/serial_port.hpp"
#include "tools/surveying/survey.hpp"
#include "tools/surveying/survey_journal.hpp"
#include "tools/surveying/survey_track.hpp"

namespace hairpin {
namespace {

constexpr const char* kKeys =
    "b blue, y yellow, o small orange, l large orange, s start pose, a a point ahead of it, "
    "u undo, q write the track and end";
constexpr int kPollPeriodMs = 100;

const std::map<char, PointKind> kKinds{{'b', PointKind::kBlue},   {'y', PointKind::kYellow},
                                       {'o', PointKind::kOrange}, {'l', PointKind::kOrangeLarge},
                                       {'s', PointKind::kStart},  {'a', PointKind::kAhead}};

struct Options {
  std::string config_dir = "config";
  std::string port;
  int baud_rate = 115200;
  std::string out;
  std::string journal;
};

SurveyParams LoadSurveyParams(const Config& config) {
  SurveyParams params{.averaging_s = config.Number("averaging_s", {0.1, 60.0}),
                      .min_fixes = config.Integer("min_fixes", 1, 1000),
                      .max_scatter_m = config.Number("max_scatter_m", {0.001, 1.0}),
                      .max_sigma_m = config.Number("max_sigma_m", {0.001, 1.0}),
                      .stale_s = config.Number("stale_s", {0.1, 60.0}),
                      .min_spacing_m = config.Number("min_spacing_m", {0.05, 2.0})};
  config.Finish();
  return params;
}

/// The keyboard, key by key, until the end of its life. Any stream where it is no terminal.
class Keyboard {
 public:
  Keyboard() : is_terminal_(tcgetattr(STDIN_FILENO, &before_) == 0) {
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keyboard() {
    if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  /// The key; 'q' at the end of the stream.
  static char Read() {
    char key = 0;
    return read(STDIN_FILENO, &key, 1) == 1 ? key : 'q';
  }

 private:
  termios before_{};
  bool is_terminal_;
};

/// One walk around the track.
class Walk {
 public:
  Walk(const Options& options, const SurveyParams& params, const GnssErrorModel& errors)
      : port_(options.port, options.baud_rate),
        decoder_(errors),
        journal_(options.journal),
        survey_(params) {
    for (const SurveyedPoint& point : journal_.points()) survey_.Restore(point);
    std::cerr << kKeys << '\n' << journal_.points().size() << " points in the journal\n";
  }

  /// Until 'q'.
  void Go() {
    const Keyboard keyboard;
    while (true) {
      std::array<pollfd, 2> waiting{{{STDIN_FILENO, POLLIN, 0}, {port_.descriptor(), POLLIN, 0}}};
      poll(waiting.data(), waiting.size(), kPollPeriodMs);
      if (waiting[1].revents != 0) Hear();
      Tell(survey_.Wait(clock_.NowMicros()));
      if (waiting[0].revents == 0) continue;
      const char key = Keyboard::Read();
      if (key == 'q') return;
      Press(key);
    }
  }
  const std::vector<SurveyedPoint>& points() const { return survey_.points(); }

 private:
  void Hear() {
    std::array<uint8_t, 1024> buffer;
    const size_t count = port_.Read(buffer);
    for (const GnssFix& fix : decoder_.Add(Bytes(buffer).first(count)))
      Tell(survey_.Add(fix, clock_.NowMicros()));
  }

  void Press(char key) {
    const auto kind = kKinds.find(key);
    if (key == 'u') {
      Tell(survey_.Undo());
    } else if (kind != kKinds.end()) {
      Tell(survey_.Press(kind->second, clock_.NowMicros()));
    } else if (key != '\n') {
      std::cerr << kKeys << '\n';
    }
  }

  // First the disk, then the word: what was announced is not lost.
  void Tell(const SurveyAnswer& answer) {
    if (answer.accepted) journal_.Append(*answer.accepted);
    if (answer.is_undone) journal_.AppendUndo();
    if (!answer.word.empty()) std::cerr << answer.word << std::endl;
  }

  MonotonicClock clock_;
  SerialPort port_;
  GnssDecoder decoder_;
  SurveyJournal journal_;
  Survey survey_;
};

void Run(const Options& options) {
  const SurveyParams params = LoadSurveyParams(Config::Load(options.config_dir, "survey"));
  const GnssDriverParams driver =
      LoadGnssDriverParams(Config::Load(options.config_dir, "gnss_driver"));
  Walk walk(options, params, driver.errors);
  walk.Go();
  SaveTrack(TrackOf(walk.points(), options.out), options.out);
  std::cerr << options.out << " is written\n";
}

int Main(int argc, char** argv) {
  CLI::App app(std::string("Surveys a track with a hand-held RTK receiver. Keys: ") + kKeys,
               "hairpin-survey");
  Options options;
  app.add_option("--port", options.port, "the receiver's serial port")->required();
  app.add_option("--baud-rate", options.baud_rate, "its rate")->capture_default_str();
  app.add_option("--out", options.out, "the track's .yaml file")->required();
  app.add_option("--journal", options.journal,
                 "every point and undo, at once on the disk; goes on where it ended (default: the "
                 "track's name with .journal)");
  AddConfigDirOption(app, options.config_dir);
  return RunProgram(app, argc, argv, [&options] {
    if (options.journal.empty()) options.journal = options.out + ".journal";
    Run(options);
    return 0;
  });
}

}  // namespace
}  // namespace hairpin

int main(int argc, char** argv) { return hairpin::Main(argc, argv); }
