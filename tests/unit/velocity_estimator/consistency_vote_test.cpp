#include "daemons/velocity_estimator/consistency_vote.hpp"

#include <gtest/gtest.h>

namespace hairpin {
namespace {

constexpr double kTolerance = 0.1;
constexpr double kLifetime = 0.25;

/// Casts the same residuals for one second at 100 Hz; returns its end.
int64_t CastForASecond(ConsistencyVote& vote, std::initializer_list<double> residuals) {
  int64_t utime = 1'000'000;
  for (int i = 0; i < 100; ++i) {
    utime += 10'000;
    size_t voter = 0;
    for (const double residual : residuals)
      vote.Cast(voter++, utime, residual, kTolerance, kLifetime);
  }
  return utime;
}

TEST(ConsistencyVote, NamesTheOneThatTwoOthersContradict) {
  ConsistencyVote vote(0.5);
  const int64_t now = CastForASecond(vote, {0.0, -0.25, -0.27});
  const auto minority = vote.MinorityAt(now);
  ASSERT_TRUE(minority);
  EXPECT_EQ(minority->voter, 0u);
  EXPECT_NEAR(minority->error, 0.27, 1e-9);
}

TEST(ConsistencyVote, NamesNobodyWithinTheTolerances) {
  ConsistencyVote vote(0.5);
  EXPECT_FALSE(vote.MinorityAt(CastForASecond(vote, {0.0, 0.19, 0.1})));
}

TEST(ConsistencyVote, TwoAgainstEachOtherProveNothing) {
  ConsistencyVote vote(0.5);
  EXPECT_FALSE(vote.MinorityAt(CastForASecond(vote, {0.0, 0.3})));
}

TEST(ConsistencyVote, ThreeOpinionsProveNothing) {
  ConsistencyVote vote(0.5);
  EXPECT_FALSE(vote.MinorityAt(CastForASecond(vote, {-0.3, 0.0, 0.3})));
}

TEST(ConsistencyVote, ForgetsAVoterThatIsSilent) {
  ConsistencyVote vote(0.5);
  const int64_t now = CastForASecond(vote, {0.0, -0.3, -0.3});
  vote.Cast(0, now + 260'000, 0.0, kTolerance, kLifetime);
  EXPECT_FALSE(vote.MinorityAt(now + 260'000));
}

TEST(ConsistencyVote, IsNotDecidedByASpike) {
  ConsistencyVote vote(0.5);
  const int64_t now = CastForASecond(vote, {0.0, 0.0, 0.0});
  vote.Cast(1, now + 10'000, 1e6, kTolerance, kLifetime);
  EXPECT_FALSE(vote.MinorityAt(now + 10'000));
}

TEST(ConsistencyVote, FindsTheFilterWrongWhereAllVotersAgreeAgainstIt) {
  ConsistencyVote vote(0.5);
  const auto error = vote.FilterErrorAt(CastForASecond(vote, {0.25, 0.2, 0.15}));
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error, 0.25, 1e-9);
}

TEST(ConsistencyVote, LeavesTheFilterAloneWhereVotersDisagreeOrOnlyOneComplains) {
  ConsistencyVote apart(0.5);
  EXPECT_FALSE(apart.FilterErrorAt(CastForASecond(apart, {0.25, -0.25, 0.0})));
  ConsistencyVote single(0.5);
  EXPECT_FALSE(single.FilterErrorAt(CastForASecond(single, {0.15, 0.05, 0.05})));
}

}  // namespace
}  // namespace hairpin
