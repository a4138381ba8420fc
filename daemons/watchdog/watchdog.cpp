#include "daemons/watchdog/watchdog.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/channels.hpp"
#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr size_t kMaxDaemons = 64;

void Require(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument("watchdog: " + rule);
}

WatchdogParams Checked(const WatchdogParams& params) {
  Require(params.status_period_s >= 1e-3, "status_period_s must be >= 0.001");
  Require(params.max_time_step_s > 0.0, "max_time_step_s must be > 0");
  Require(params.degraded_speed_cap > 0.0, "degraded_speed_cap must be > 0");
  Require(params.fusion_speed_cap >= params.degraded_speed_cap,
          "fusion_speed_cap must be >= degraded_speed_cap");
  Require(params.max_flaps >= 0, "max_flaps must be >= 0");
  Require(params.flap_window_s > 0.0, "flap_window_s must be > 0");
  Require(params.lost_after_s > 0.0, "lost_after_s must be > 0");
  Require(params.silence_s > 0.0, "silence_s must be > 0");
  const SourceParams& source = params.source;
  Require(source.health_s > 0.0, "health_s must be > 0");
  Require(source.max_late_in_a_row >= 0, "max_late_in_a_row must be >= 0");
  Require(source.second_publisher_returns > 0, "second_publisher_returns must be > 0");
  Require(source.second_publisher_window_s > 0.0, "second_publisher_window_s must be > 0");
  Require(source.restart_loop_restarts > 0, "restart_loop_restarts must be > 0");
  Require(source.restart_loop_window_s > 0.0, "restart_loop_window_s must be > 0");
  LossDetector(source.tolerated_loss, source.degrading_loss, source.loss_evidence);
  return params;
}

std::string Joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + "; " + b;
}

}  // namespace

Watchdog::Watchdog(const WatchdogParams& params, const std::vector<SourceSpec>& sources,
                   const std::vector<SourceSpec>& daemons)
    : params_(Checked(params)),
      status_period_micros_(AddSeconds(0, params.status_period_s)),
      daemon_specs_(daemons),
      mode_({params.max_flaps, params.flap_window_s, params.source.health_s}) {
  for (const SourceSpec& spec : sources) sources_.emplace_back(spec, params.source);
  const auto check_answers = [this](const SourceSpec& spec) {
    for (const std::string& name : spec.answers)
      Require(IsChannel(name), spec.name + " answers unknown " + name);
  };
  std::for_each(sources.begin(), sources.end(), check_answers);
  std::for_each(daemons.begin(), daemons.end(), check_answers);
}

std::optional<WatchdogStatus> Watchdog::Hear(size_t source, const Stamp& stamp) {
  const int64_t before = now_;
  if (MovesTimeTooFar(source, stamp)) return std::nullopt;
  Take(source, stamp);
  return now_ > before ? Step() : std::nullopt;
}

// One message far ahead of all others would make everything else look stale: it waits until the
// next message, of whatever channel, agrees.
bool Watchdog::MovesTimeTooFar(size_t source, const Stamp& stamp) {
  const std::optional<Pending> waiting = std::exchange(pending_, std::nullopt);
  if (now_ == 0 || SecondsBetween(now_, stamp.utime) <= params_.max_time_step_s) return false;
  if (waiting && SecondsBetween(stamp.utime, waiting->stamp.utime) <= params_.max_time_step_s) {
    Take(waiting->source, waiting->stamp);
    return false;
  }
  pending_ = {source, stamp};
  return true;
}

void Watchdog::Take(size_t source, const Stamp& stamp) {
  now_ = std::max(now_, stamp.utime);
  Source& heard = sources_.at(source);
  heard.Hear(stamp, now_);
  AwaitAnswers(heard.spec());
}

void Watchdog::AwaitAnswers(const SourceSpec& cause) {
  if (cause.pipeline && !Uses(mode_.mode(), *cause.pipeline)) return;  // the mapper ignores it
  const auto await = [&](Source& source) {
    const std::vector<std::string>& causes = source.spec().answers;
    if (std::find(causes.begin(), causes.end(), cause.name) != causes.end()) source.Await(now_);
  };
  for (Source& source : sources_) await(source);
  for (auto& [name, source] : daemons_) await(source);
}

bool Watchdog::HearHeartbeat(const std::string& daemon, const Stamp& stamp) {
  auto found = daemons_.find(daemon);
  if (found == daemons_.end()) {
    if (daemons_.size() == kMaxDaemons) return false;
    SourceSpec spec{daemon, channels::kHeartbeat.rate_hz, channels::kHeartbeat.deadline_s};
    for (const SourceSpec& known : daemon_specs_) {
      if (known.name == daemon) spec = known;
    }
    found = daemons_.emplace(daemon, Source(spec, params_.source)).first;
  }
  // A daemon may live and hear nothing: it is silent only when nothing comes from it.
  found->second.Hear({now_, stamp.boot_id, stamp.sequence}, now_);
  return true;
}

std::optional<WatchdogStatus> Watchdog::Step() {
  for (Source& source : sources_) source.Advance(now_);
  mode_.Update(now_, Flags(&Source::Fresh), Flags(&Source::Healthy));
  const std::vector<Finding> findings = Findings();
  const Level level = LevelOf(findings);
  const int64_t cell = now_ / status_period_micros_;
  if (cell <= published_cell_ && mode_.mode() == published_mode_ && level <= published_level_)
    return std::nullopt;
  published_cell_ = cell;
  published_mode_ = mode_.mode();
  published_level_ = level;
  return StatusOf(findings);
}

PipelineFlags Watchdog::Flags(bool (Source::*judge)(int64_t) const) const {
  PipelineFlags flags{};
  for (const Source& source : sources_) {
    if (source.spec().pipeline)
      flags[static_cast<size_t>(*source.spec().pipeline)] = (source.*judge)(now_);
  }
  return flags;
}

std::optional<Watchdog::Finding> Watchdog::Staleness(const Source& source) const {
  const double age = source.Age(now_);
  if (age > source.spec().deadline_s + params_.lost_after_s)
    return Finding{&source, "is lost", source.spec().when_lost};
  if (age > source.spec().deadline_s) return Finding{&source, "is stale", source.spec().when_stale};
  return std::nullopt;
}

void Watchdog::Inspect(const Source& source, std::vector<Finding>& findings) const {
  const SourceSpec& spec = source.spec();
  const auto add = [&](const char* what, Level level) {
    findings.push_back({&source, what, level});
  };
  const BootTracker& boots = source.boots();
  if (const std::optional<Finding> staleness = Staleness(source)) findings.push_back(*staleness);
  if (boots.has_second_publisher(now_)) {
    add("has a second publisher", spec.when_disputed);
  } else if (boots.suspects_second_publisher(now_)) {
    add("may have a second publisher", Level::kLog);
  }
  if (boots.in_restart_loop(now_)) add("restarts again and again", spec.when_disputed);
  if (source.losses().alarmed()) add("loses messages", spec.when_sick);
  if (source.late()) add("is late", spec.when_sick);
}

std::vector<Watchdog::Finding> Watchdog::Findings() const {
  std::vector<Finding> findings;
  for (const Source& source : sources_) Inspect(source, findings);
  for (const auto& [name, source] : daemons_) Inspect(source, findings);
  return findings;
}

Level Watchdog::LevelOf(const std::vector<Finding>& findings) const {
  Level level = Level::kDegrade;
  if (mode_.mode() == MapMode::kFusion) level = Level::kLog;
  if (mode_.mode() == MapMode::kNone) level = Level::kControlledStop;
  for (const Finding& finding : findings) level = std::max(level, finding.level);
  return level;
}

WatchdogStatus Watchdog::StatusOf(const std::vector<Finding>& findings) const {
  WatchdogStatus status;
  status.utime = now_;
  status.mode = mode_.mode();
  status.level = LevelOf(findings);
  status.speed_cap =
      status.level == Level::kLog ? params_.fusion_speed_cap : params_.degraded_speed_cap;
  status.fresh = Flags(&Source::Fresh);
  status.latched = mode_.latched();
  status.reason = ModeReason();
  for (const Finding& finding : findings) {
    const std::string& name = finding.source->spec().name;
    status.reason = Joined(status.reason, name + " " + finding.what);
    if (status.culprits.empty() || status.culprits.back() != name) status.culprits.push_back(name);
  }
  if (status.reason.empty()) status.reason = "healthy";
  return status;
}

std::string Watchdog::ModeReason() const {
  const bool any_heard = std::any_of(sources_.begin(), sources_.end(), [](const Source& source) {
    return source.spec().pipeline && source.heard();
  });
  if (!any_heard) return "no pipeline heard yet";
  if (mode_.latched()) return "map mode flapped too often and no longer rises";
  const PipelineFlags fresh = Flags(&Source::Fresh);
  const MapMode possible = DecideMapMode(fresh[0], fresh[1], fresh[2]);
  if (possible > mode_.mode()) return std::string(NameOf(possible)) + " waits to prove its health";
  return {};
}

WatchdogStatus Watchdog::Silent() const {
  WatchdogStatus status;
  status.utime = now_;
  status.level = Level::kControlledStop;
  status.speed_cap = params_.degraded_speed_cap;
  status.latched = mode_.latched();
  status.reason = "data time stands still: nothing new is heard on any channel";
  for (const Source& source : sources_) {
    if (source.heard()) status.culprits.push_back(source.spec().name);
  }
  return status;
}

bool Watchdog::IsChannel(const std::string& name) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [&name](const Source& source) { return source.spec().name == name; });
}

}  // namespace hairpin
