#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace hairpin {

/// Independent sensors of one quantity, compared with one another. A filter follows a sensor that
/// drifts slowly, if that sensor is precise enough, and then rejects the sound ones; a majority
/// tells them apart. Each voter's residual against the filter is averaged, so that the filter's own
/// error cancels in the differences.
class ConsistencyVote {
 public:
  static constexpr size_t kMaxVoters = 3;

  /// A residual counts for at most this many tolerances, so that a spike does not decide a vote.
  static constexpr double kMostTolerances = 3.0;

  /// `time_constant`: of the averages [s].
  explicit ConsistencyVote(double time_constant) : time_constant_(time_constant) {}

  /// A residual (measured - filter) of `voter`, with the systematic error that a sound one may
  /// have. It counts until `lifetime` [s] has passed without another.
  void Cast(size_t voter, int64_t utime, double residual, double tolerance, double lifetime);

  /// The one voter that differs from all others, at least two, by more than their tolerances
  /// together, while those agree with one another.
  struct Minority {
    size_t voter;
    double error;  // largest averaged residual of the majority: what the filter is off by
  };
  std::optional<Minority> MinorityAt(int64_t now) const;

  /// Largest averaged residual where all voters agree with one another, and at least two of them
  /// contradict the filter.
  std::optional<double> FilterErrorAt(int64_t now) const;

 private:
  struct Ballot {
    int64_t utime = 0;
    double mean = 0.0;
    double averaged = 0.0;  // s behind the mean, up to the time constant
    double tolerance = 0.0;
    double lifetime = 0.0;
    bool present = false;
  };
  static bool IsPresent(const Ballot& ballot, int64_t now);
  static bool Agree(const Ballot& a, const Ballot& b);
  bool IsAlone(size_t voter, int64_t now) const;

  double time_constant_;
  std::array<Ballot, kMaxVoters> ballots_{};
};

}  // namespace hairpin
