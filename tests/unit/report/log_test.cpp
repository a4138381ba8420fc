#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>

#include "tools/report/log_reader.hpp"
#include "tools/report/log_writer.hpp"

namespace hairpin {
namespace {

using Bytes = std::vector<uint8_t>;

class EventLog : public testing::Test {
 protected:
  EventLog()
      : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() +
              ".lcmlog") {}
  ~EventLog() override { std::filesystem::remove(path_); }

  static Bytes Payload(int64_t i) {
    return Bytes(static_cast<size_t>(10 + i % 50), static_cast<uint8_t>(i));
  }

  void WriteEvents(int64_t count) const {
    LogWriter writer(path_);
    for (int64_t i = 0; i < count; ++i) {
      const Bytes data = Payload(i);
      writer.Write(1'000'000 + i * 1000, i % 2 == 0 ? "TRUTH" : "VELOCITY", data.data(),
                   data.size());
    }
    writer.Close();
  }

  Bytes FileBytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  void Replace(const Bytes& bytes) const {
    std::ofstream file(path_, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  std::vector<int64_t> NumbersRead(int64_t* skipped = nullptr) const {
    LogReader reader(path_);
    std::vector<int64_t> numbers;
    while (const auto event = reader.Next()) {
      EXPECT_EQ(event->data, Payload(event->number));
      numbers.push_back(event->number);
    }
    if (skipped) *skipped = reader.skipped_bytes();
    return numbers;
  }

  /// Where event `number` begins.
  size_t OffsetOf(int64_t number) const {
    size_t offset = 0;
    for (int64_t i = 0; i < number; ++i) offset += 28 + (i % 2 == 0 ? 5 : 8) + Payload(i).size();
    return offset;
  }

  std::string path_;
};

TEST_F(EventLog, ReadsBackWhatWasWritten) {
  WriteEvents(5000);
  LogReader reader(path_);
  for (int64_t i = 0; i < 5000; ++i) {
    const auto event = reader.Next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->number, i);
    EXPECT_EQ(event->timestamp_us, 1'000'000 + i * 1000);
    EXPECT_EQ(event->channel, i % 2 == 0 ? "TRUTH" : "VELOCITY");
    EXPECT_EQ(event->data, Payload(i));
  }
  EXPECT_FALSE(reader.Next());
  EXPECT_EQ(reader.skipped_bytes(), 0);
}

TEST_F(EventLog, IsReadByTheStockReader) {
  WriteEvents(300);
  lcm::LogFile stock(path_, "r");
  ASSERT_TRUE(stock.good());
  for (int64_t i = 0; i < 300; ++i) {
    const lcm::LogEvent* event = stock.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1'000'000 + i * 1000);
    EXPECT_EQ(event->channel, i % 2 == 0 ? "TRUTH" : "VELOCITY");
    const auto* data = static_cast<const uint8_t*>(event->data);
    EXPECT_EQ(Bytes(data, data + event->datalen), Payload(i));
  }
  EXPECT_EQ(stock.readNextEvent(), nullptr);
}

TEST_F(EventLog, ReadsAndWritesTheStockWritersVeryBytes) {
  {
    lcm::LogFile stock(path_, "w");
    for (int64_t i = 0; i < 100; ++i) {
      Bytes data = Payload(i);
      lcm::LogEvent event{0, 1'000'000 + i * 1000, i % 2 == 0 ? "TRUTH" : "VELOCITY",
                          static_cast<int32_t>(data.size()), data.data()};
      ASSERT_EQ(stock.writeEvent(&event), 0);
    }
  }
  EXPECT_EQ(NumbersRead().size(), 100u);
  const Bytes stock_bytes = FileBytes();
  WriteEvents(100);
  EXPECT_EQ(FileBytes(), stock_bytes);
}

TEST_F(EventLog, ReadsALogRecordedByOthers) {
  const char* data = std::getenv("HAIRPIN_DATA");
  const std::string directory = data ? data : HAIRPIN_SOURCE_DIR "/../shared/data";
  const std::string path = directory + "/example.lcmlog";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  LogReader reader(path);
  int events = 0;
  while (reader.Next()) ++events;
  EXPECT_EQ(events, 10);
  EXPECT_EQ(reader.skipped_bytes(), 0);
}

TEST_F(EventLog, GoesOnAfterDamageAnywhereAndLosesOnlyTheEventHit) {
  WriteEvents(30);
  const Bytes sound = FileBytes();
  for (size_t position = OffsetOf(10); position < OffsetOf(11); ++position) {
    Bytes damaged = sound;
    damaged[position] ^= 0x80;
    Replace(damaged);
    LogReader reader(path_);
    std::vector<Bytes> payloads;
    while (const auto event = reader.Next()) payloads.push_back(event->data);
    ASSERT_GE(payloads.size(), 29u) << "byte " << position;
    for (int64_t i = 0; i < 10; ++i)
      ASSERT_EQ(payloads[static_cast<size_t>(i)], Payload(i)) << "byte " << position;
    for (size_t last = 1; last <= 19; ++last) {
      ASSERT_EQ(payloads[payloads.size() - last], Payload(30 - static_cast<int64_t>(last)))
          << "byte " << position;
    }
  }
}

TEST_F(EventLog, CountsTheBytesSkipped) {
  WriteEvents(20);
  Bytes bytes = FileBytes();
  const Bytes rubbish(333, 0xED);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(OffsetOf(7)), rubbish.begin(),
               rubbish.end());
  Replace(bytes);
  int64_t skipped = 0;
  EXPECT_EQ(NumbersRead(&skipped).size(), 20u);
  EXPECT_EQ(skipped, 333);
}

TEST_F(EventLog, ReadsALogCutOffAnywhereUpToTheCut) {
  WriteEvents(12);
  const Bytes sound = FileBytes();
  for (size_t size = OffsetOf(9); size < OffsetOf(11); ++size) {
    Replace(Bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)));
    int64_t skipped = 0;
    const size_t whole = size < OffsetOf(10) ? 9u : 10u;
    ASSERT_EQ(NumbersRead(&skipped).size(), whole) << size;
    EXPECT_EQ(skipped, static_cast<int64_t>(size - OffsetOf(static_cast<int64_t>(whole)))) << size;
  }
}

TEST_F(EventLog, ALengthThatSwallowsTheNextEventsIsSeenThrough) {
  WriteEvents(30);
  Bytes bytes = FileBytes();
  bytes[OffsetOf(4) + 26] = 1;  // 256 bytes more
  Replace(bytes);
  std::vector<int64_t> numbers = NumbersRead();
  EXPECT_EQ(numbers.size(), 29u);
  EXPECT_THAT(numbers, testing::Not(testing::Contains(4)));
}

TEST_F(EventLog, LengthsBeyondTheBoundsAllocateNothing) {
  WriteEvents(3);
  Bytes bytes = FileBytes();
  bytes[OffsetOf(1) + 24] = 0x7f;  // 2 GiB of data
  Replace(bytes);
  EXPECT_THAT(NumbersRead(), testing::ElementsAre(0, 2));
  bytes[OffsetOf(1) + 24] = 0xff;  // negative
  Replace(bytes);
  EXPECT_THAT(NumbersRead(), testing::ElementsAre(0, 2));
}

TEST_F(EventLog, AFileThatIsNoLogHoldsNoEvents) {
  Replace(Bytes(600'001, 0xDA));
  int64_t skipped = 0;
  EXPECT_TRUE(NumbersRead(&skipped).empty());
  EXPECT_EQ(skipped, 600'001);
  Replace({});
  EXPECT_TRUE(NumbersRead(&skipped).empty());
  EXPECT_EQ(skipped, 0);
}

TEST_F(EventLog, ReachesTheFileWithinASecondOfTimestamps) {
  LogWriter writer(path_);
  const Bytes data(8, 1);
  for (int64_t t = 0; t <= 1'000'000; t += 10'000) writer.Write(t, "IMU", data.data(), data.size());
  LogReader reader(path_);
  int events = 0;
  while (reader.Next()) ++events;
  EXPECT_EQ(events, 101);
}

TEST_F(EventLog, RefusesWhatIsNoEvent) {
  LogWriter writer(path_);
  EXPECT_THROW(writer.Write(0, "", nullptr, 0), std::invalid_argument);
  EXPECT_THROW(writer.Write(0, std::string(64, 'A'), nullptr, 0), std::invalid_argument);
  writer.Close();
  EXPECT_THROW(writer.Write(0, "IMU", nullptr, 0), std::logic_error);
}

TEST_F(EventLog, SaysThatAFileCannotBeOpenedOrTheDiskIsFull) {
  EXPECT_THROW(LogReader("/nonexistent/x.lcmlog"), std::runtime_error);
  EXPECT_THROW(LogWriter("/nonexistent/x.lcmlog"), std::runtime_error);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  LogWriter writer("/dev/full");
  const Bytes data(100, 1);
  writer.Write(0, "IMU", data.data(), data.size());
  EXPECT_THROW(writer.Close(), std::runtime_error);
}

}  // namespace
}  // namespace hairpin
