#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/map_mode.hpp"
#include "daemons/watchdog/event_window.hpp"

namespace hairpin {

/// What follows from a fault, numbered as on the wire.
enum class Level {
  kLog = pipeline_status_t::LEVEL_LOG,
  kDegrade = pipeline_status_t::LEVEL_DEGRADE,
  kControlledStop = pipeline_status_t::LEVEL_CONTROLLED_STOP,
  kEmergency = pipeline_status_t::LEVEL_EMERGENCY,
};

/// A source of messages that is watched: a channel, or a daemon's heartbeat.
struct SourceSpec {
  std::string name;         // as it is named among the culprits
  double rate_hz = 0.0;     // nominal
  double deadline_s = 0.0;  // stale when older than this
  std::vector<std::string>
      answers{};  // channels whose messages cause this one's; none: it has a rhythm of its own
  std::optional<Pipeline>
      pipeline{};  // that it is the output of; the map mode says what its staleness means
  Level when_stale = Level::kLog;
  Level when_lost = Level::kLog;      // stale for long
  Level when_sick = Level::kLog;      // losing messages, late
  Level when_disputed = Level::kLog;  // second publisher, restarting in a loop
};

/// Who sent a message, when it was measured and which of the sender's messages it is.
struct Stamp {
  int64_t utime = 0;
  int64_t boot_id = 0;
  int64_t sequence = 0;
};

struct SourceParams {
  double health_s = 0.0;  // fresh for this long is healthy
  int max_late_in_a_row = 0;
  double tolerated_loss = 0.0;  // share of messages whose loss has no effect
  double degrading_loss = 0.0;  // share whose loss degrades
  double loss_evidence = 0.0;   // log-likelihood ratio between the two that raises the alarm
  int second_publisher_returns = 0;
  double second_publisher_window_s = 0.0;
  int restart_loop_restarts = 0;
  double restart_loop_window_s = 0.0;
};

/// Tells a loss of `degrading_loss` from one of `tolerated_loss` by the gaps in the senders'
/// sequences, as soon as the evidence allows: a cumulative sum of log-likelihood ratios [Page
/// 1954], which needs no window length that would suit both 10 and 100 Hz.
class LossDetector {
 public:
  LossDetector(double tolerated_loss, double degrading_loss, double evidence);
  /// Throws std::invalid_argument unless 0 < tolerated < degrading < 1 and evidence > 0.
  void Add(const Stamp& stamp);
  /// From reaching the evidence until all of it is refuted.
  bool alarmed() const { return alarmed_; }

 private:
  void Score(double ratio);

  double lost_ratio_;
  double received_ratio_;
  double evidence_;
  double sum_ = 0.0;
  bool alarmed_ = false;
  std::optional<Stamp> newest_;
};

/// Tells a restarted sender from a second one: the boot id of a restarted sender never returns.
class BootTracker {
 public:
  explicit BootTracker(const SourceParams& params);
  void Add(int64_t now, int64_t boot_id);
  /// An older boot id has spoken again, lately.
  bool suspects_second_publisher(int64_t now) const { return returns_.Any(now); }
  /// ... and again and again: no straggler of a sender that ended.
  bool has_second_publisher(int64_t now) const { return returns_.Reached(now); }
  bool in_restart_loop(int64_t now) const { return restarts_.Reached(now); }

 private:
  std::deque<int64_t> boots_;  // the last few, the one that spoke last at the end
  EventWindow returns_;
  EventWindow restarts_;
};

/// One watched source: how old its newest message is, for how long it has been healthy, and what is
/// wrong with its sender. All in data time; `now` is the newest utime heard on any channel and
/// never decreases.
class Source {
 public:
  Source(const SourceSpec& spec, const SourceParams& params);

  void Hear(const Stamp& stamp, int64_t now);
  /// To be told whenever data time has advanced: being found stale interrupts the health.
  void Advance(int64_t now);

  /// A message that causes one of this source's was heard.
  void Await(int64_t now);

  bool heard() const { return heard_; }
  /// What its deadline bounds [s]: for how long it has owed an answer, or for one with a rhythm of
  /// its own, how old its newest message is. 0 before the first was heard: the car starts in any
  /// order.
  double Age(int64_t now) const;
  bool Fresh(int64_t now) const;
  /// Fresh for `health_s` without a lapse. A lapse that is explained by messages lost on the way,
  /// while the sender went on at its rate, is none.
  bool Healthy(int64_t now) const;
  /// More than `max_late_in_a_row` messages were past the deadline when they arrived.
  bool late() const { return late_in_a_row_ > params_.max_late_in_a_row; }

  const SourceSpec& spec() const { return spec_; }
  const LossDetector& losses() const { return losses_; }
  const BootTracker& boots() const { return boots_; }

 private:
  bool ExplainedByLoss(const Stamp& stamp) const;

  SourceSpec spec_;
  SourceParams params_;
  LossDetector losses_;
  BootTracker boots_;
  bool heard_ = false;
  Stamp newest_;
  std::optional<int64_t> owes_since_;
  bool lapsed_ = false;
  int64_t healthy_since_ = 0;
  int late_in_a_row_ = 0;
};

}  // namespace hairpin
