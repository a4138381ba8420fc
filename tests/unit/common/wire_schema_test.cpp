#include "common/wire_schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/unit/common/sample_messages.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;

constexpr size_t kFingerprint = 8;

// What is wrong with an encoded message, behind its fingerprint.
std::string ProblemOf(const std::string& type, const std::vector<uint8_t>& bytes) {
  return WireSchema::Hairpin().Problem(type, bytes.data() + kFingerprint,
                                       bytes.size() - kFingerprint);
}

template <class M>
std::string ProblemOf(const M& message) {
  return ProblemOf(M::getTypeName(), Encoded(message));
}

// Calls `test(sample)` with a filled message of every channel.
template <class Test>
void ForEachSample(Test test) {
  ForEachChannel([&test](const auto& channel) {
    test(Sample<typename std::decay_t<decltype(channel)>::Message>(1'000));
  });
}

void Overwrite(std::vector<uint8_t>& bytes, size_t offset, int32_t value) {
  for (int i = 0; i < 4; ++i)
    bytes[offset + static_cast<size_t>(i)] =
        static_cast<uint8_t>(static_cast<uint32_t>(value) >> (24 - 8 * i));
}

// Where cones_t holds the number of its sectors, and its first sector begins.
constexpr size_t kNumSectors = kFingerprint + 20;

TEST(WireSchema, AcceptsEveryMessageOfTheChannelTable) {
  ForEachSample(
      [](const auto& sample) { EXPECT_EQ(ProblemOf(sample), "") << sample.getTypeName(); });
}

TEST(WireSchema, RefusesEveryMessageCutOffAtAnyByte) {
  ForEachSample([](const auto& sample) {
    std::vector<uint8_t> bytes = Encoded(sample);
    while (bytes.size() > kFingerprint) {
      bytes.pop_back();
      ASSERT_NE(ProblemOf(sample.getTypeName(), bytes), "")
          << sample.getTypeName() << " of " << bytes.size();
    }
  });
}

TEST(WireSchema, RefusesTrailingBytes) {
  ForEachSample([](const auto& sample) {
    std::vector<uint8_t> bytes = Encoded(sample);
    bytes.push_back(0);
    EXPECT_THAT(ProblemOf(sample.getTypeName(), bytes), HasSubstr("trailing"));
  });
}

TEST(WireSchema, RefusesNanAndInfinityInEveryField) {
  for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()}) {
    ForEachSample([poison](auto sample) {
      int tested = 0;
      VisitReals(sample, [&](auto& real) {
        const auto good = real;
        real = static_cast<std::decay_t<decltype(real)>>(poison);
        EXPECT_THAT(ProblemOf(sample), HasSubstr("not finite"))
            << sample.getTypeName() << ", real " << tested;
        real = good;
        ++tested;
      });
      EXPECT_EQ(ProblemOf(sample), "");
    });
  }
}

TEST(WireSchema, RefusesNegativeAndHugeLengths) {
  std::vector<uint8_t> bytes = Encoded(Sample<cones_t>(1));
  for (const int32_t length : {-1, std::numeric_limits<int32_t>::min()}) {
    Overwrite(bytes, kNumSectors, length);
    EXPECT_EQ(ProblemOf("cones_t", bytes), "negative length of sectors");
  }
  for (const int32_t length : {1000, 1 << 30, std::numeric_limits<int32_t>::max()}) {
    Overwrite(bytes, kNumSectors, length);
    EXPECT_EQ(ProblemOf("cones_t", bytes), "length of sectors exceeds the payload");
  }
}

TEST(WireSchema, RefusesALengthThatTheRestOfThePayloadDoesNotFill) {
  std::vector<uint8_t> bytes = Encoded(Sample<cones_t>(1));
  for (const int32_t length : {0, 2, 20}) {
    Overwrite(bytes, kNumSectors, length);
    EXPECT_NE(ProblemOf("cones_t", bytes), "") << length;
  }
}

TEST(WireSchema, RefusesStringsThatDoNotEndWhereTheySay) {
  const std::vector<uint8_t> good = Encoded(Sample<as_state_t>(1));  // its reason stands last
  std::vector<uint8_t> unterminated = good;
  unterminated.back() = 'x';
  EXPECT_THAT(ProblemOf("as_state_t", unterminated), HasSubstr("not terminated"));
  std::vector<uint8_t> cut_short = good;
  cut_short[good.size() - 3] = 0;
  EXPECT_THAT(ProblemOf("as_state_t", cut_short), HasSubstr("not terminated")) << "a zero inside";
  const size_t length = good.size() - std::string("ready").size() - 1 - 4;
  for (const int32_t claimed : {0, -1, 7, 1 << 30}) {
    std::vector<uint8_t> bytes = good;
    Overwrite(bytes, length, claimed);
    EXPECT_NE(ProblemOf("as_state_t", bytes), "") << claimed;
  }
}

TEST(WireSchema, RefusesBooleansThatAreNone) {
  std::vector<uint8_t> bytes = Encoded(Sample<velocity_t>(1));
  const size_t valid = kFingerprint + 20;
  bytes[valid] = 2;
  EXPECT_EQ(ProblemOf("velocity_t", bytes), "valid is no boolean");
}

TEST(WireSchema, NeverLetsTheDecoderFailOnARandomMutation) {
  std::mt19937 random(42);
  int passed = 0;
  ForEachSample([&](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const std::vector<uint8_t> good = Encoded(sample);
    for (int i = 0; i < 10'000; ++i) {
      std::vector<uint8_t> bytes = good;
      for (auto flips = 1 + random() % 8; flips > 0; --flips) {
        bytes[kFingerprint + random() % (bytes.size() - kFingerprint)] =
            static_cast<uint8_t>(random());
      }
      if (random() % 4 == 0)
        bytes.resize(kFingerprint + random() % (bytes.size() - kFingerprint + 1));
      if (!ProblemOf(Message::getTypeName(), bytes).empty()) continue;
      ++passed;
      Message decoded;
      ASSERT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
                static_cast<int>(bytes.size()));
      ASSERT_EQ(Encoded(decoded), bytes) << "what is accepted is understood to the last byte";
    }
  });
  EXPECT_GT(passed, 1000) << "the mutations must reach the decoder at all";
}

TEST(WireSchema, UnderstandsArraysOfSeveralDimensionsAndEveryPrimitive) {
  const WireSchema schema(R"(
    package test; // a comment { with a brace
    struct inner_t { byte b; int8_t c; int16_t d; float e; }
    struct outer_t { const int32_t N = 3; int16_t n; test.inner_t grid[n][2]; /* block */ string name; boolean ok[2]; })");
  const std::vector<uint8_t> good{0, 1, 1, 2, 0, 3, 0, 0, 0, 0, 1, 2, 0,
                                  3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1};
  EXPECT_EQ(schema.Problem("outer_t", good.data(), good.size()), "");
  EXPECT_NE(schema.Problem("outer_t", good.data(), good.size() - 1), "");
}

TEST(WireSchema, RefusesTheProductOfLengthsThatFitOneByOne) {
  const WireSchema schema("struct grid_t { int32_t n; int32_t m; double values[n][m]; }");
  std::vector<uint8_t> bytes(100, 0);
  Overwrite(bytes, 0, 90);
  Overwrite(bytes, 4, 90);
  EXPECT_EQ(schema.Problem("grid_t", bytes.data(), bytes.size()),
            "length of values exceeds the payload");
}

TEST(WireSchema, RefusesDefinitionsThatItCannotUnderstand) {
  EXPECT_THROW(WireSchema("struct a_t { missing_t x; }"), std::invalid_argument);
  EXPECT_THROW(WireSchema("struct a_t { double x[n]; int32_t n; }"), std::invalid_argument);
  EXPECT_THROW(WireSchema("struct a_t { double n; double x[n]; }"), std::invalid_argument);
  std::string fields;
  for (int i = 0; i < 65; ++i) fields += "double x" + std::to_string(i) + "; ";
  EXPECT_THROW(WireSchema("struct a_t { " + fields + "}"), std::invalid_argument);
  EXPECT_THROW(WireSchema::Hairpin().Problem("no_such_t", nullptr, 0), std::out_of_range);
}

}  // namespace
}  // namespace hairpin
