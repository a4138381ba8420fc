#include "common/channels.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "common/clock.hpp"
#include "common/map_mode.hpp"

namespace hairpin {
namespace {

TEST(ChannelTable, HasUniqueNamesThatAreNoRegularExpressions) {
  std::set<std::string> names;
  ForEachChannel([&names](const auto& channel) {
    EXPECT_TRUE(names.insert(channel.name).second) << channel.name;
    EXPECT_EQ(std::string(channel.name).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_"),
              std::string::npos)
        << channel.name;
  });
  EXPECT_EQ(names.size(), 23u);
}

TEST(ChannelTable, CallsNoChannelStaleThatKeepsItsRate) {
  ForEachChannel([](const auto& channel) {
    EXPECT_GE(channel.deadline_s, 2.0 / channel.rate_hz) << channel.name;
  });
}

TEST(ChannelTable, LetsOnlyHeartbeatsHaveManySenders) {
  ForEachChannel([](const auto& channel) {
    EXPECT_EQ(channel.many_senders, std::string(channel.name) == "HEARTBEAT");
  });
}

TEST(TypesHash, IsTheSameEachTimeAndNotZero) {
  EXPECT_EQ(TypesHash(), TypesHash());
  EXPECT_NE(TypesHash(), 0);
}

TEST(MapMode, SaysWhichPipelinesItUses) {
  const auto uses = [](MapMode mode) {
    std::string text;
    if (Uses(mode, Pipeline::kFusion)) text += "F";
    if (Uses(mode, Pipeline::kLidar)) text += "L";
    if (Uses(mode, Pipeline::kCamera)) text += "C";
    return text;
  };
  EXPECT_EQ(uses(MapMode::kFusion), "F") << "nothing else: it would be the same information twice";
  EXPECT_EQ(uses(MapMode::kLidarAndCamera), "LC");
  EXPECT_EQ(uses(MapMode::kLidarOnly), "L");
  EXPECT_EQ(uses(MapMode::kCameraOnly), "C");
  EXPECT_EQ(uses(MapMode::kNone), "");
  EXPECT_EQ(uses(MapMode::kUnknown), "");
}

TEST(MapMode, HasANameForEveryNumber) {
  EXPECT_STREQ(NameOf(MapMode::kLidarAndCamera), "LIDAR_AND_CAMERA");
  EXPECT_STREQ(NameOf(static_cast<MapMode>(99)), "UNKNOWN");
}

TEST(Time, ConvertsBothWays) {
  EXPECT_DOUBLE_EQ(SecondsBetween(1'000'000, 1'250'000), 0.25);
  EXPECT_DOUBLE_EQ(SecondsBetween(1'250'000, 1'000'000), -0.25);
  EXPECT_EQ(AddSeconds(1'700'000'000'000'000, 0.1), 1'700'000'000'100'000);
  EXPECT_EQ(AddSeconds(1'000'000, -0.25), 750'000);
}

TEST(MonotonicClock, DoesNotGoBack) {
  const MonotonicClock clock;
  const int64_t first = clock.NowMicros();
  EXPECT_GE(clock.NowMicros(), first);
}

}  // namespace
}  // namespace hairpin
