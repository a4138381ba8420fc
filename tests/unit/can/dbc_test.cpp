// The generated pack and unpack code against python3-canmatrix, which reads the same database.
#include "common/can/dbc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

namespace hairpin {
namespace {

constexpr int kFrames = 3'500;   // of each message, three signals or more in each
constexpr int kValues = 10'000;  // at least

uint64_t ToBits(const std::string& hex) {
  uint64_t bits = 0;
  for (size_t i = 0; i < hex.size() / 2; ++i)
    bits |= static_cast<uint64_t>(std::stoul(hex.substr(2 * i, 2), nullptr, 16)) << 8 * i;
  return bits;
}

using Values = std::map<std::string, double>;

template <class M>
M FromValues(const Values& values) {
  M message;
  M::VisitSignals(message, [&values](const char* name, auto& value, const dbc::Range&) {
    value = static_cast<std::decay_t<decltype(value)>>(values.at(name));
  });
  return message;
}

/// What the oracle says of one message, against what the generated code does.
struct Comparison {
  int values = 0;
  int differences = 0;
};

template <class M>
Comparison Compare(const std::vector<std::pair<uint64_t, Values>>& frames) {
  Comparison result;
  for (size_t i = 0; i < frames.size(); ++i) {
    const auto& [bits, values] = frames[i];
    const M unpacked = M::FromBits(bits);
    size_t signals = 0;
    bool same = true;
    M::VisitSignals(unpacked, [&, &wanted = values](const char* name, auto value,
                                                    const dbc::Range&) {
      const double expected = wanted.at(name);
      same = same && std::abs(static_cast<double>(value) - expected) <= 1e-12 * std::abs(expected);
      ++signals;
    });
    const bool packed_by_oracle = i % 2 == 0;  // else random bytes, with bits that nothing names
    if (packed_by_oracle) same = same && M::ToBits(FromValues<M>(values)) == bits;
    result.values += static_cast<int>(signals);
    if (!same || signals != values.size()) ++result.differences;
  }
  return result;
}

TEST(Dbc, PacksAndUnpacksEveryFrameAsTheOracleDoes) {
  const std::string command = std::string("/usr/bin/python3 ") + HAIRPIN_SOURCE_DIR +
                              "/tests/unit/can/dbc_oracle.py " + HAIRPIN_SOURCE_DIR +
                              "/config/hairpin.dbc " + std::to_string(kFrames) + " 7";
  FILE* oracle = popen(command.c_str(), "r");
  ASSERT_NE(oracle, nullptr);
  std::map<std::string, std::vector<std::pair<uint64_t, Values>>> frames;
  char line[1024];
  while (std::fgets(line, sizeof line, oracle) != nullptr) {
    std::istringstream words(line);
    std::string name;
    std::string hex;
    words >> name >> hex;
    Values values;
    for (std::string word; words >> word;) {
      const size_t equals = word.find('=');
      values[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
    }
    frames[name].emplace_back(ToBits(hex), std::move(values));
  }
  ASSERT_EQ(pclose(oracle), 0);
  size_t messages = 0;
  dbc::ForEachMessage([&]<class M>(const M&) {
    const Comparison comparison = Compare<M>(frames[M::kName]);
    EXPECT_GE(comparison.values, kValues) << M::kName;
    EXPECT_EQ(comparison.differences, 0) << M::kName;
    ++messages;
  });
  EXPECT_EQ(messages, frames.size()) << "a message of the database has no code";
}

TEST(Dbc, KeepsEveryIdentifierOnce) {
  std::map<uint32_t, std::string> names;
  dbc::ForEachMessage([&names]<class M>(const M&) {
    EXPECT_TRUE(names.emplace(M::kId, M::kName).second) << M::kName;
    EXPECT_LE(M::kId, 0x7FFu) << M::kName;
    EXPECT_GT(M::kPeriodMs, 0) << M::kName;
  });
}

TEST(Dbc, RefusesToPackWhatIsOutOfRangeAndNamesTheSignal) {
  for (const double angle : {1.01, -1.01, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      dbc::Pack(dbc::SteeringCommand{.angle_rad = angle});
      FAIL() << angle;
    } catch (const std::invalid_argument& error) {
      EXPECT_STREQ(error.what(), "STEERING_COMMAND: Angle is out of range");
    }
  }
}

TEST(Dbc, SaturatesASensorAtTheEndOfItsScale) {
  const auto saturated = dbc::Saturated(dbc::ImuAcceleration{.x_mps2 = 1e9, .y_mps2 = -1e9});
  EXPECT_EQ(saturated.x_mps2, 60.0);
  EXPECT_EQ(saturated.y_mps2, -60.0);
}

TEST(Dbc, RefusesAFrameOfWrongLengthChecksumOrRange) {
  dbc::WheelSpeedsFront message{.sample_time = 7, .left_radps = 12.34, .right_radps = -5.0};
  const CanFrame good = dbc::Pack(message);
  dbc::WheelSpeedsFront unpacked;
  EXPECT_EQ(dbc::Unpack(good, unpacked), "");
  EXPECT_NEAR(unpacked.left_radps, 12.34, 1e-9);
  CanFrame bad = good;
  bad.length = 7;
  EXPECT_EQ(dbc::Unpack(bad, unpacked), "length");
  bad = good;
  bad.data[2] = 0xFF;
  bad.data[3] = 0x7F;  // 327.67 rad/s
  EXPECT_EQ(dbc::Unpack(bad, unpacked), "checksum");
  bad.data[7] = ProtectionOf(bad);
  EXPECT_EQ(dbc::Unpack(bad, unpacked), "range of Left");
}

TEST(Dbc, FindsEveryFlippedBitOfAProtectedFrame) {
  const CanFrame good = dbc::Pack(dbc::BrakeCommand{.command_time = 5, .level_percent = 30.0});
  for (size_t bit = 0; bit < 8u * good.length; ++bit) {
    CanFrame bad = good;
    bad.data[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    dbc::BrakeCommand message;
    EXPECT_EQ(dbc::Unpack(bad, message), "checksum") << bit;
  }
}

TEST(Dbc, DoesNotTakeAFrameUnderAnotherIdentifier) {
  CanFrame frame = dbc::Pack(dbc::TorqueCommandFront{.left_nm = 100.0});
  frame.id = dbc::TorqueCommandRear::kId;
  dbc::TorqueCommandRear message;
  EXPECT_EQ(dbc::Unpack(frame, message), "checksum");
}

TEST(Crc8, IsThatOfSaeJ1850) {
  const std::string check = "123456789";
  EXPECT_EQ(Crc8(reinterpret_cast<const uint8_t*>(check.data()), check.size()), 0x4B);
}

class Counter : public testing::Test {
 protected:
  std::string Receive(int counter) {
    dbc::Brakes message{.counter = static_cast<uint8_t>(counter)};
    return receiver_.Unpack(dbc::Pack(message), message);
  }
  dbc::Receiver<dbc::Brakes> receiver_;
};

TEST_F(Counter, MayStepOverTwoLostFramesAndWrap) {
  for (const int counter : {14, 15, 0, 3, 5}) EXPECT_EQ(Receive(counter), "") << counter;
}

TEST_F(Counter, ThatRepeatsIsRefused) {
  EXPECT_EQ(Receive(4), "");
  EXPECT_EQ(Receive(4), "counter repeats");
  EXPECT_EQ(Receive(4), "counter repeats");
  EXPECT_EQ(Receive(5), "");
}

TEST_F(Counter, ThatJumpsIsRefusedOnce) {
  EXPECT_EQ(Receive(4), "");
  EXPECT_EQ(Receive(9), "counter jumps");
  EXPECT_EQ(Receive(10), "");
}

TEST_F(Counter, GoesUpWithEachFrameThatIsSent) {
  dbc::Sender<dbc::Brakes> sender;
  for (int i = 0; i < 40; ++i) {
    dbc::Brakes message;
    EXPECT_EQ(receiver_.Unpack(sender.Pack({}), message), "");
    EXPECT_EQ(message.counter, i % 16);
  }
}

}  // namespace
}  // namespace hairpin
