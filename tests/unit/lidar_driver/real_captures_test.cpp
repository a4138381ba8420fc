// Captures of real sensors by other people (see the README beside the data); skipped where absent.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "daemons/lidar_driver/pcap_reader.hpp"
#include "tests/support/lidar_setup.hpp"
#include "tests/support/rosbag_packets.hpp"

namespace hairpin {
namespace {

using Cloud = std::vector<Eigen::Vector3f>;

std::string PacketsFolder() { return RealData() + "/lidar_packets/"; }

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is absent"

// Binary PCD whose points begin with x y z as floats.
Cloud ReadCloud(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  size_t count = 0;
  size_t point_size = 0;
  for (std::string line; std::getline(file, line) && line != "DATA binary";) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "POINTS") words >> count;
    for (size_t size = 0; key == "SIZE" && words >> size;) point_size += size;
  }
  Cloud cloud;
  std::vector<char> bytes(point_size);
  while (cloud.size() < count && file.read(bytes.data(), static_cast<std::streamsize>(point_size)))
    std::memcpy(cloud.emplace_back().data(), bytes.data(), 3 * sizeof(float));
  return cloud;
}

/// Nearest neighbours by a grid of 10 cm; looks no further than a cell.
class Neighbours {
 public:
  explicit Neighbours(const Cloud& cloud) {
    for (const auto& point : cloud) cells_[CellOf(point)].push_back(point);
  }
  float Distance(const Eigen::Vector3f& point) const {
    float nearest = 0.1f;
    const auto [x, y, z] = CellOf(point);
    for (int i = 0; i < 27; ++i) {
      const auto cell = cells_.find({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
      if (cell == cells_.end()) continue;
      for (const auto& other : cell->second) nearest = std::min(nearest, (other - point).norm());
    }
    return nearest;
  }

 private:
  using Cell = std::tuple<int, int, int>;
  static Cell CellOf(const Eigen::Vector3f& point) {
    const auto index = [](float value) { return static_cast<int>(std::floor(value * 10.0f)); };
    return {index(point.x()), index(point.y()), index(point.z())};
  }
  std::map<Cell, Cloud> cells_;
};

std::vector<float> Distances(const Cloud& from, const Cloud& to) {
  const Neighbours neighbours(to);
  std::vector<float> distances;
  for (const auto& point : from) distances.push_back(neighbours.Distance(point));
  std::sort(distances.begin(), distances.end());
  return distances;
}

double ShareWithin(const std::vector<float>& sorted, float limit) {
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), limit);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

void ExpectEqualClouds(const Cloud& ours, const Cloud& published) {
  const double count_ratio =
      static_cast<double>(ours.size()) / static_cast<double>(published.size());
  EXPECT_NEAR(count_ratio, 1.0, 0.01) << ours.size() << " points to " << published.size();
  for (const auto& distances : {Distances(ours, published), Distances(published, ours)}) {
    EXPECT_GE(ShareWithin(distances, 0.02f), 0.95);
    EXPECT_LE(distances[distances.size() / 2], 0.005f);
  }
  testing::Test::RecordProperty("within_20mm",
                                std::to_string(ShareWithin(Distances(ours, published), 0.02f)));
}

const std::string kVlp32 = PacketsFolder() + "nebula/vlp32/1713492677464078412";

TEST(RealVlp32c, FirstScanEqualsThePublishedCloud) {
  SKIP_WITHOUT(kVlp32);
  const VelodyneDecoder decoder(Vlp32c());
  DecodedPacket decoded;
  Cloud ours;
  const auto scans = ReadVelodyneScans(kVlp32 + "/1713492677464078412_0.db3");
  for (const auto& packet : scans.front()) {
    ASSERT_FALSE(decoder.Decode(packet.bytes, decoded));
    for (const auto& point : decoded.points) ours.push_back(point.position);
  }
  ExpectEqualClouds(ours, ReadCloud(kVlp32 + ".pcd"));
}

// The sensor was set to the half of the circle that begins at 270.4 degrees of azimuth.
TEST(RealVlp32c, RevolutionsCutInTheBlindHalfHaveThePointsOfThePublishedCloud) {
  SKIP_WITHOUT(kVlp32);
  LidarDriver driver = MakeDriver(Vlp32c(), 180.0);
  std::vector<Revolution> revolutions;
  for (const auto& scan : ReadVelodyneScans(kVlp32 + "/1713492677464078412_0.db3")) {
    for (const auto& packet : scan) {
      auto result = driver.Add({packet.bytes, packet.utime, {}});
      ASSERT_FALSE(result.refused) << result.refused->what;
      if (result.revolution) revolutions.push_back(std::move(*result.revolution));
    }
  }
  ASSERT_GE(revolutions.size(), 3u);
  for (const Revolution& revolution : revolutions) {
    EXPECT_NEAR(revolution.covered_share, 0.5, 0.02);
    EXPECT_NEAR(revolution.column_step * 18000.0 / std::numbers::pi, 19.9, 0.2);
    EXPECT_NEAR(revolution.points.front().age, 0.05f, 0.005f);
  }
  EXPECT_NEAR(static_cast<double>(revolutions.front().points.size()), 26216.0, 262.0);
}

struct Read {
  std::vector<Revolution> revolutions;
  std::string refused;  // the first one's words
  RefusalCounts counts{};
  int64_t used = 0;
  TimeSource source = TimeSource::kUnknown;
};

Read ReadCapture(const std::string& path, const VelodyneParams& sensor, double gnss_wait_s = 0.0) {
  LidarDriver driver = MakeDriver(sensor, 120.0, gnss_wait_s);
  PcapReader reader(path, {});
  Read read;
  while (const auto packet = reader.Next()) {
    auto result = driver.Add(*packet);
    if (result.revolution) read.revolutions.push_back(std::move(*result.revolution));
    if (result.refused && read.refused.empty()) read.refused = result.refused->what;
  }
  read.counts = driver.refused();
  read.used = driver.used();
  read.source = driver.time_source();
  return read;
}

int64_t Count(const Read& read, Refusal reason) { return read.counts[static_cast<size_t>(reason)]; }

TEST(RealCaptures, OfAnHdl32eAreRefusedByName) {
  for (const char* name :
       {"mrpt/sample_velodyne_hdl32.pcap", "rust_lidar_utils/velodyne_vlp32.pcap"}) {
    SKIP_WITHOUT(PacketsFolder() + name);
    const Read read = ReadCapture(PacketsFolder() + name, Vlp32c());
    EXPECT_THAT(read.refused, testing::HasSubstr("HDL-32E"));
    EXPECT_GE(Count(read, Refusal::kModel), 91);
    EXPECT_EQ(read.used, 0);
    EXPECT_TRUE(read.revolutions.empty());
  }
}

TEST(RealCaptures, OfAnOusterAreRefusedByName) {
  const std::string path = PacketsFolder() + "rust_lidar_utils/ouster_example.pcap";
  SKIP_WITHOUT(path);
  const Read read = ReadCapture(path, Vlp32c());
  EXPECT_THAT(read.refused, testing::HasSubstr("Ouster OS1"));
  EXPECT_EQ(Count(read, Refusal::kModel), 100);
  EXPECT_EQ(read.used, 0);
}

TEST(RealCaptures, OfAVlp16AreRefusedByAVlp32cAndDecodedByAVlp16) {
  const std::string path = PacketsFolder() + "mrpt/sample_velodyne_vlp16_gps.pcap";
  SKIP_WITHOUT(path);
  const Read refused = ReadCapture(path, Vlp32c());
  EXPECT_THAT(refused.refused, testing::HasSubstr("VLP-16"));
  EXPECT_EQ(refused.used, 0);
  const Read read = ReadCapture(path, Vlp16(), 3.0);
  EXPECT_EQ(read.used, 293);
  EXPECT_EQ(read.source, TimeSource::kGnss);
  ASSERT_FALSE(read.revolutions.empty());
  // 21 January 2016, 08:18 UTC by the sentences.
  EXPECT_NEAR(static_cast<double>(read.revolutions.front().utime) * 1e-6, 1453364282.4, 1.0);
}

TEST(RealVlp16, PublishedCloudIsAmongTheDecodedPoints) {
  const std::string folder = PacketsFolder() + "nebula/vlp16/";
  SKIP_WITHOUT(folder);
  const VelodyneDecoder decoder(Vlp16());
  DecodedPacket decoded;
  Cloud ours;
  const auto scans = ReadVelodyneScans(folder + "1673400471837873222/1673400471837873222_0.db3");
  for (const auto& scan : scans)
    for (const auto& packet : scan) {
      const auto refused = decoder.Decode(packet.bytes, decoded);
      ASSERT_FALSE(refused) << refused->what;
      for (const auto& point : decoded.points) ours.push_back(point.position);
    }
  const Cloud published = ReadCloud(folder + "1673400472138016708.pcd");
  EXPECT_GE(ShareWithin(Distances(published, ours), 0.02f), 0.95);
}

}  // namespace
}  // namespace hairpin
