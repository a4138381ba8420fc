#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "common/clock.hpp"
#include "common/daemon.hpp"
#include "common/program.hpp"
#include "tools/evaluation/commands.hpp"
#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/receiver_truth.hpp"
#include "tools/evaluation/recording_error.hpp"
#include "tools/evaluation/truth_log.hpp"
#include "tools/report/statistics.hpp"
#include "tools/report/trajectory.hpp"

namespace hairpin {
namespace {

struct TruthOptions {
  std::string log, track, receiver, out;
  std::string config_dir = "config";
  std::vector<std::string> overrides;
  bool replace = false;
  bool json = false;
};

Track LoadSurveyedTrack(const std::string& file) {
  Track track = LoadTrack(file);
  if (!track.origin) {
    throw RecordingError(
        file + ": origin: is missing: where on Earth the track lies; tools/survey writes it");
  }
  return track;
}

RunLog LoadLog(const TruthOptions& options) {
  if (!std::filesystem::exists(options.log)) throw RecordingError(options.log + ": no such file");
  RunLog log = LoadRunLog(options.log);
  if (log.events == 0) throw RecordingError(options.log + ": holds no event");
  if (!options.replace && (!log.truth.empty() || log.truth_track))
    throw RecordingError(options.log + ": holds TRUTH already; --replace replaces it");
  return log;
}

/// What the receiver said, by its own recording or else by the run's GNSS.
ReceiverRecording LoadFixes(const TruthOptions& options, const RunLog& log, const Track& track) {
  const GnssDriverParams driver =
      LoadGnssDriverParams(Config::Load(options.config_dir, "gnss_driver", options.overrides));
  if (!options.receiver.empty()) return ReadReceiver(options.receiver, driver, *track.origin);
  if (driver.origin_is_first_fix) {
    throw RecordingError(options.log +
                         ": its GNSS tells no place on Earth, since gnss_driver.yaml says "
                         "origin.is_first_fix: name the receiver's own recording (--receiver), or "
                         "the origin that the run had");
  }
  return {InMap(log.gnss, driver.origin, *track.origin), {}};
}

/// "fixes: 933, float: 27, no_heading: 906"
std::string Account(size_t fixes, const ReceiverTruth& truth) {
  std::ostringstream text;
  text << "fixes: " << fixes;
  for (const auto& [reason, count] : truth.left_out) {
    if (count > 0) text << ", " << reason << ": " << count;
  }
  return text.str();
}

void RequireTruth(const TruthOptions& options, const ReceiverRecording& recording,
                  const std::vector<gnss_t>& during, const ReceiverTruth& truth) {
  if (!truth.truth.empty()) return;
  const std::string& source = options.receiver.empty() ? options.log : options.receiver;
  if (recording.fixes.empty()) throw RecordingError(source + ": holds no fix of a receiver");
  if (during.empty()) {
    throw RecordingError(source + ": none of its " + std::to_string(recording.fixes.size()) +
                         " fixes lies within the time of " + options.log);
  }
  const bool is_fixed =
      truth.left_out.at("no_heading") + truth.left_out.at("uncertain") + truth.left_out.at("lone") >
      0;
  std::string why = "no fixed RTK solution";
  if (is_fixed) why = "no fixed RTK solution that is good enough";
  if (truth.left_out.at("no_heading") > 0)
    why = "no fixed RTK solution with a heading (HDT, or NAV-RELPOSNED: a second antenna)";
  throw RecordingError(source + ": " + why + " (" + Account(during.size(), truth) + ")");
}

nlohmann::json GapsJson(const ReceiverTruth& truth) {
  nlohmann::json gaps = nlohmann::json::array();
  for (const TruthGap& gap : truth.gaps) {
    gaps.push_back({{"from_s", SecondsBetween(truth.truth.front().utime, gap.from_utime)},
                    {"duration_s", SecondsBetween(gap.from_utime, gap.to_utime)}});
  }
  return gaps;
}

/// Of the receiver's truth from the one that the log holds; null where it holds none.
nlohmann::json DeviationJson(const RunLog& log, const std::vector<truth_t>& truth) {
  const TrueTrajectory trajectory(log);
  std::vector<double> positions;
  std::vector<double> yaws;
  for (const truth_t& pose : truth) {
    const std::optional<TrueState> state = trajectory.At(pose.utime);
    if (!state) continue;
    const Pose2& other = state->T_map_base;
    positions.push_back((Eigen::Vector2d(pose.x_m, pose.y_m) - other.position()).norm());
    yaws.push_back(WrapAngle(pose.yaw_rad - other.yaw));
  }
  return {{"position_rms_m", OrNull(RootMeanSquare(positions))},
          {"position_max_m", OrNull(Percentile(positions, 100.0))},
          {"yaw_rms_rad", OrNull(RootMeanSquare(yaws))}};
}

void Run(const TruthOptions& options) {
  std::error_code none;  // a file that is not there yet is no other's
  if (std::filesystem::equivalent(options.log, options.out, none))
    throw CLI::ValidationError("--out", "is the log itself");
  const Track track = LoadSurveyedTrack(options.track);
  const RunLog log = LoadLog(options);
  const ReceiverTruthParams params =
      LoadReceiverTruthParams(Config::Load(options.config_dir, "truth"));
  const ReceiverRecording recording = LoadFixes(options, log, track);
  const std::vector<gnss_t> during = DuringLog(recording.fixes, log);
  const ReceiverTruth result = TruthOfReceiver(during, track, params);
  RequireTruth(options, recording, during, result);
  WriteTruthLog(options.log, options.out, track, result.truth);
  const std::vector<truth_t>& truth = result.truth;
  nlohmann::json figures{
      {"fixes", recording.fixes.size()},
      {"outside_log", recording.fixes.size() - during.size()},
      {"left_out", result.left_out},
      {"truths", truth.size()},
      {"duration_s", SecondsBetween(truth.front().utime, truth.back().utime)},
      {"gaps", GapsJson(result)},
      {"distance_m", truth.back().distance_m},
      {"laps", truth.back().lap},
      {"bad_frames", recording.bad_frames},
      {"deviation", DeviationJson(log, truth)},
      {"log", options.log},
      {"receiver", options.receiver.empty() ? nlohmann::json() : nlohmann::json(options.receiver)},
      {"track", track.name},
      {"build", BuildId()}};
  PrintFigures(figures, options.json);
}

}  // namespace

void AddTruthCommand(CLI::App& app) {
  CLI::App* truth = app.add_subcommand(
      "truth",
      "a run's log with the true motion by the car's own dual-antenna RTK receiver: TRUTH at each "
      "fixed solution, and TRUTH_TRACK, for the other subcommands to read as of a simulated run");
  const auto options = std::make_shared<TruthOptions>();
  truth->add_option("--log", options->log, "log.lcmlog of the run")->required();
  truth->add_option("--track", options->track, "the surveyed track, with its origin (.yaml)")
      ->required();
  truth->add_option("--receiver", options->receiver,
                    "bytes of the receiver's serial port, NMEA or UBX, as it recorded them itself "
                    "(default: GNSS of the log, from the origin of gnss_driver.yaml)");
  truth->add_option("--out", options->out, "log to write")->required();
  truth->add_flag("--replace", options->replace,
                  "where the log holds TRUTH already, a simulator's: leave it out, and tell how "
                  "far it was");
  AddConfigDirOption(*truth, options->config_dir);
  truth
      ->add_option("--set", options->overrides,
                   "KEY=VALUE in place of gnss_driver.yaml's value (repeatable)")
      ->allow_extra_args(false);
  truth->add_flag("--json", options->json, "print one JSON object");
  truth->callback([options] { Run(*options); });
}

}  // namespace hairpin
