#include "daemons/watchdog/source.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/clock.hpp"

namespace hairpin {
namespace {

// A longer gap is an outage, which staleness judges, and not a share of losses.
constexpr int64_t kMaxGap = 3;
constexpr size_t kRememberedBoots = 4;

}  // namespace

LossDetector::LossDetector(double tolerated_loss, double degrading_loss, double evidence)
    : lost_ratio_(std::log(degrading_loss / tolerated_loss)),
      received_ratio_(std::log((1.0 - degrading_loss) / (1.0 - tolerated_loss))),
      evidence_(evidence) {
  if (!(tolerated_loss > 0.0))
    throw std::invalid_argument("LossDetector: tolerated_loss must be > 0");
  if (!(degrading_loss > tolerated_loss && degrading_loss < 1.0)) {
    throw std::invalid_argument("LossDetector: degrading_loss must be > tolerated_loss and < 1");
  }
  if (!(evidence > 0.0)) throw std::invalid_argument("LossDetector: loss_evidence must be > 0");
}

void LossDetector::Add(const Stamp& stamp) {
  const bool same_sender = newest_ && newest_->boot_id == stamp.boot_id;
  const int64_t ahead = same_sender ? stamp.sequence - newest_->sequence : 1;
  if (ahead > 0) {
    newest_ = stamp;
    Score(static_cast<double>(std::min(ahead - 1, kMaxGap)) * lost_ratio_);
  } else {
    Score(-lost_ratio_);  // it was counted as lost, and has come late
  }
  Score(received_ratio_);
}

void LossDetector::Score(double ratio) {
  sum_ = std::clamp(sum_ + ratio, 0.0, evidence_);
  alarmed_ = sum_ >= evidence_ || (alarmed_ && sum_ > 0.0);
}

BootTracker::BootTracker(const SourceParams& params)
    : returns_(params.second_publisher_window_s,
               static_cast<size_t>(params.second_publisher_returns)),
      restarts_(params.restart_loop_window_s, static_cast<size_t>(params.restart_loop_restarts)) {}

void BootTracker::Add(int64_t now, int64_t boot_id) {
  if (!boots_.empty() && boots_.back() == boot_id) return;
  const auto known = std::find(boots_.begin(), boots_.end(), boot_id);
  if (known != boots_.end()) {
    boots_.erase(known);
    returns_.Add(now);
  } else if (!boots_.empty()) {
    restarts_.Add(now);
  }
  boots_.push_back(boot_id);
  if (boots_.size() > kRememberedBoots) boots_.pop_front();
}

Source::Source(const SourceSpec& spec, const SourceParams& params)
    : spec_(spec),
      params_(params),
      losses_(params.tolerated_loss, params.degrading_loss, params.loss_evidence),
      boots_(params) {
  if (!(spec.rate_hz > 0.0)) throw std::invalid_argument(spec.name + ": rate_hz must be > 0");
  if (!(spec.deadline_s > 0.0)) throw std::invalid_argument(spec.name + ": deadline_s must be > 0");
}

void Source::Hear(const Stamp& stamp, int64_t now) {
  owes_since_.reset();
  losses_.Add(stamp);
  boots_.Add(now, stamp.boot_id);
  late_in_a_row_ = SecondsBetween(stamp.utime, now) > spec_.deadline_s ? late_in_a_row_ + 1 : 0;
  if (heard_ && stamp.utime <= newest_.utime) return;
  const bool gap = heard_ && SecondsBetween(newest_.utime, stamp.utime) > spec_.deadline_s;
  const bool lapse = !heard_ || ((lapsed_ || gap) && !ExplainedByLoss(stamp));
  heard_ = true;
  newest_ = stamp;
  lapsed_ = !Fresh(now);
  if (lapse) healthy_since_ = now;
}

void Source::Advance(int64_t now) {
  if (!Fresh(now)) lapsed_ = true;
}

void Source::Await(int64_t now) {
  if (!owes_since_) owes_since_ = now;
}

double Source::Age(int64_t now) const {
  if (!heard_) return 0.0;
  if (spec_.answers.empty()) return SecondsBetween(newest_.utime, now);
  return owes_since_ ? SecondsBetween(*owes_since_, now) : 0.0;
}

bool Source::Fresh(int64_t now) const {
  return heard_ && SecondsBetween(newest_.utime, now) <= spec_.deadline_s;
}

bool Source::Healthy(int64_t now) const {
  return Fresh(now) && SecondsBetween(healthy_since_, now) >= params_.health_s;
}

bool Source::ExplainedByLoss(const Stamp& stamp) const {
  const int64_t steps = stamp.sequence - newest_.sequence;
  if (stamp.boot_id != newest_.boot_id || steps < 2 || steps > kMaxGap + 1) return false;
  const double period = SecondsBetween(newest_.utime, stamp.utime) / static_cast<double>(steps);
  return period <= 1.5 / spec_.rate_hz;
}

}  // namespace hairpin
