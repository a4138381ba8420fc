#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "daemons/global_mapper/journal.hpp"
#include "daemons/global_mapper/map_file.hpp"
#include "daemons/global_mapper/record_codec.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

KeyframeRecord Keyframe(int64_t utime) {
  KeyframeRecord keyframe{utime, 7, {1.0, 2.0, 0.3}, {1.1, 2.1, 0.31}, {1.0, 0.0, 0.01}, {}, {}};
  keyframe.covariance << 0.01, 0.001, 0.0, 0.001, 0.02, 0.0, 0.0, 0.0, 0.003;
  SightingRecord sighting;
  sighting.landmark = 3;
  sighting.local_id = 12;
  sighting.position = {4.0, -1.5};
  sighting.covariance << 0.02, 0.004, 0.004, 0.01;
  sighting.colour = {0.5, 2.0, 0.25, 0.0, 0.0};
  sighting.num_observations = 3;
  sighting.local_observations = 9;
  keyframe.sightings = {sighting, sighting};
  return keyframe;
}

std::vector<MapRecord> Records() {
  PlaceRecord place{3'500'000, 7, {1.0, 2.0, 0.3}, {1.1, 2.1, 0.31}, {}, 4, 812.5, 790.0};
  place.covariance << 0.01, 0.001, 0.0, 0.001, 0.02, 0.0, 0.0, 0.0, 0.003;
  return {Keyframe(1'000'000), Keyframe(2'000'000),
          MergeRecord{2'500'000, true, true, {{9, 1}, {8, 2}}}, RemovalRecord{3'000'000, {4, 5}},
          place};
}

std::string Bytes(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(RecordCodec, GivesBackWhatItWasGiven) {
  for (const MapRecord& record : Records()) {
    const auto bytes = Encode(record);
    const auto decoded = DecodeMapRecord(bytes);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(Encode(*decoded), bytes);
  }
}

TEST(RecordCodec, RefusesEveryTruncationAndALengthThatCannotBe) {
  const auto bytes = Encode(Records()[0]);
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(DecodeMapRecord(std::span(bytes).first(size))) << size;
  auto hostile = Encode(Records()[3]);
  for (size_t i = 16; i < 23; ++i) hostile[i] = 0xff;
  EXPECT_FALSE(DecodeMapRecord(hostile));
}

TEST(Journal, ToleratesATornTailAtEveryByteAndGoesOnBehindTheLastWholeRecord) {
  const TemporaryFolder folder;
  const std::string file = folder.File("journal");
  {
    Journal journal(file, 1 << 20);
    journal.Start();
    journal.Append(Records(), 1);
    EXPECT_EQ(journal.problem(), "");
  }
  const std::string whole = Bytes(file);
  EXPECT_EQ(ReadJournal(file).records.size(), Records().size());
  for (size_t size = 0; size < whole.size(); size += 7) {
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(whole.data(), static_cast<std::streamsize>(size));
    const JournalContents contents = ReadJournal(file);
    EXPECT_EQ(contents.good_bytes + contents.bad_bytes, static_cast<int64_t>(size));
    ASSERT_LT(contents.records.size(), Records().size());
    {
      Journal journal(file, 1 << 20);
      journal.Continue(contents.good_bytes);
      journal.Append({Records()[3]}, 2);
    }
    EXPECT_EQ(ReadJournal(file).records.size(), contents.records.size() + 1);
    EXPECT_EQ(ReadJournal(file).bad_bytes, 0);
  }
}

TEST(Journal, StopsAtARecordOfWhichOneBitHasFlipped) {
  const TemporaryFolder folder;
  const std::string file = folder.File("journal");
  {
    Journal journal(file, 1 << 20);
    journal.Start();
    journal.Append(Records(), 1);
  }
  std::string bytes = Bytes(file);
  const size_t first = 12 + Encode(Records()[0]).size();
  bytes[first + 40] ^= 1;
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  EXPECT_EQ(ReadJournal(file).records.size(), 1u);
}

TEST(Journal, NeverGrowsBeyondItsBoundAndSaysSo) {
  const TemporaryFolder folder;
  Journal journal(folder.File("journal"), 2000);
  journal.Start();
  for (int i = 0; i < 20; ++i) journal.Append({Keyframe(i)}, i);
  EXPECT_NE(journal.problem().find("bound"), std::string::npos);
  EXPECT_LE(std::filesystem::file_size(folder.File("journal")), 2000u);
}

TEST(Journal, OfAFolderThatIsNotThereSaysSoAndLosesNothingElse) {
  Journal journal("/nonexistent/journal", 2000);
  journal.Start();
  journal.Append(Records(), 1);
  EXPECT_NE(journal.problem().find("/nonexistent/journal"), std::string::npos);
}

MapFile SomeMap() {
  MapFile map{42, 1'700'000'000'000'000, 2, {0.0, 0.0, 0.1}, MapGate{{6.0, 1.5}, {6.0, -1.5}}, {}};
  GlobalCone cone;
  cone.id = 5;
  cone.position = {12.3456, -7.5};
  cone.covariance << 0.01, 0.002, 0.002, 0.02;
  cone.colour = {0.1, 0.8, 0.1, 0.0, 0.0};
  cone.num_observations = 77;
  map.cones = {cone, cone};
  map.driven = {{0.0, 0.0}, {1.25, -0.5}};
  return map;
}

TEST(MapFile, IsReadBackAsItWasWritten) {
  const TemporaryFolder folder;
  SaveMapFile(SomeMap(), folder.File("map.yaml"));
  const MapFile map = LoadMapFile(folder.File("map.yaml"));
  EXPECT_EQ(ToYaml(map), ToYaml(SomeMap()));
  EXPECT_EQ(map.session, 42);
  ASSERT_EQ(map.cones.size(), 2u);
  EXPECT_NEAR(map.cones[0].position.x(), 12.3456, 1e-9);
  EXPECT_EQ(MostProbable(map.cones[0].colour), ConeColour::kBlue);
  ASSERT_EQ(map.driven.size(), 2u);
  EXPECT_NEAR(map.driven[1].x(), 1.25, 1e-9);
  ASSERT_TRUE(map.gate);
  EXPECT_NEAR(map.gate->left.y(), 1.5, 1e-9);
}

TEST(MapFile, ThatIsWrongIsRefusedWithItsLine) {
  const auto problem = [](const std::string& from, const std::string& to) -> std::string {
    std::string text = ToYaml(SomeMap());
    text.replace(text.find(from), from.size(), to);
    try {
      ParseMapFile(text, "map.yaml");
    } catch (const MapFileError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(problem("laps: 2", "lapse: 2").find("unknown key `lapse`"), std::string::npos);
  EXPECT_NE(problem("[12.3456", "[.nan").find("out of range"), std::string::npos);
  EXPECT_NE(problem("1.0000e-02", "-1.0").find("positive definite"), std::string::npos);
  EXPECT_NE(problem("colour: blue", "colour: mauve").find("no such colour"), std::string::npos);
  EXPECT_NE(problem("hairpin_map: 1", "hairpin_map: 9").find("version"), std::string::npos);
  EXPECT_NE(problem("[1.2500", "[1e9").find("driven_m is out of range"), std::string::npos);
  EXPECT_NE(problem("session: 42", "session: [").find("map.yaml:"), std::string::npos);
}

TEST(MapFile, ThatIsNotThereIsSaidToBe) {
  EXPECT_THROW(LoadMapFile("/nonexistent/map.yaml"), MapFileError);
}

}  // namespace
}  // namespace hairpin
