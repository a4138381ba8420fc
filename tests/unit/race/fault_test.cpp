#include "tools/race/fault.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hairpin {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<std::string> kSources{"fusion", "lidar", "local_mapper"};

TEST(Fault, OffForGood) {
  const Fault fault = ParseFault("fusion off at 10 s", kSources);
  EXPECT_EQ(fault.source, "fusion");
  EXPECT_FALSE(fault.ActiveAt(9.99));
  EXPECT_TRUE(fault.ActiveAt(10.0));
  EXPECT_TRUE(fault.ActiveAt(1e6));
}

TEST(Fault, OffForAWhileComesBack) {
  const Fault fault = ParseFault("local_mapper off at 2.5 s for 0.5 s", kSources);
  EXPECT_FALSE(fault.ActiveAt(2.49));
  EXPECT_TRUE(fault.ActiveAt(2.5));
  EXPECT_TRUE(fault.ActiveAt(2.99));
  EXPECT_FALSE(fault.ActiveAt(3.0));
}

TEST(Fault, SaysWhatItExpectedWhereItDoesNotUnderstand) {
  for (const char* text :
       {"", "fusion", "fusion off", "fusion off at ten s", "fusion off at -1 s", "fusion on at 1 s",
        "fusion off at 10 s for", "fusion off at 10 s for 2 s please"}) {
    EXPECT_THAT([text] { ParseFault(text, kSources); },
                ThrowsMessage<FaultError>(HasSubstr("expected `SOURCE off at SECONDS s")))
        << text;
  }
}

TEST(Fault, NamesTheNearestSourceForAnUnknownOne) {
  EXPECT_THAT([] { ParseFault("fuson off at 1 s", kSources); },
              ThrowsMessage<FaultError>(HasSubstr("did you mean fusion?")));
}

}  // namespace
}  // namespace hairpin
