#include "daemons/velocity_estimator/consistency_vote.hpp"

#include <algorithm>
#include <cmath>

#include "common/clock.hpp"

namespace hairpin {

void ConsistencyVote::Cast(size_t voter, int64_t utime, double residual, double tolerance,
                           double lifetime) {
  const double bounded =
      std::clamp(residual, -kMostTolerances * tolerance, kMostTolerances * tolerance);
  Ballot& ballot = ballots_.at(voter);
  if (!IsPresent(ballot, utime)) ballot = {utime, bounded, 0.0, tolerance, lifetime, true};
  const double dt = SecondsBetween(ballot.utime, utime);
  ballot.averaged = std::min(ballot.averaged + dt, time_constant_);
  const double weight = dt > 0.0 ? std::min(dt / ballot.averaged, 1.0) : 0.0;
  ballot.mean += weight * (bounded - ballot.mean);
  ballot.tolerance += weight * (tolerance - ballot.tolerance);
  ballot.utime = utime;
}

std::optional<ConsistencyVote::Minority> ConsistencyVote::MinorityAt(int64_t now) const {
  for (size_t voter = 0; voter < kMaxVoters; ++voter) {
    if (!IsAlone(voter, now)) continue;
    Minority minority{voter, 0.0};
    for (size_t other = 0; other < kMaxVoters; ++other) {
      if (other == voter || !IsPresent(ballots_[other], now)) continue;
      minority.error = std::max(minority.error, std::abs(ballots_[other].mean));
    }
    return minority;
  }
  return std::nullopt;
}

bool ConsistencyVote::IsAlone(size_t voter, int64_t now) const {
  const Ballot& own = ballots_[voter];
  if (!IsPresent(own, now)) return false;
  std::array<const Ballot*, kMaxVoters> others{};
  size_t count = 0;
  for (const Ballot& other : ballots_) {
    if (&other == &own || !IsPresent(other, now)) continue;
    if (Agree(own, other)) return false;
    for (size_t i = 0; i < count; ++i) {
      if (!Agree(*others[i], other)) return false;
    }
    others[count++] = &other;
  }
  return count >= 2;
}

std::optional<double> ConsistencyVote::FilterErrorAt(int64_t now) const {
  double error = 0.0;
  int against = 0;
  for (const Ballot& ballot : ballots_) {
    if (!IsPresent(ballot, now)) continue;
    for (const Ballot& other : ballots_) {
      if (IsPresent(other, now) && !Agree(ballot, other)) return std::nullopt;
    }
    if (std::abs(ballot.mean) <= ballot.tolerance) continue;
    error = std::max(error, std::abs(ballot.mean));
    ++against;
  }
  return against >= 2 ? std::optional(error) : std::nullopt;
}

bool ConsistencyVote::IsPresent(const Ballot& ballot, int64_t now) {
  return ballot.present && SecondsBetween(ballot.utime, now) <= ballot.lifetime;
}

bool ConsistencyVote::Agree(const Ballot& a, const Ballot& b) {
  return std::abs(a.mean - b.mean) <= a.tolerance + b.tolerance;
}

}  // namespace hairpin
