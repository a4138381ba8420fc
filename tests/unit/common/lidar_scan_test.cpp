#include "common/lidar_scan.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <string>

#include "common/crc32c.hpp"

namespace hairpin {
namespace {

lidar_scan_t EmptyScan() {
  lidar_scan_t scan{};
  scan.coordinate_step_m = 0.004;
  scan.time_step_s = 2e-6;
  scan.covered_share = 1.0;
  scan.ring_elevation_rad = {-0.2f, 0.0f, 0.1f};
  scan.num_rings = 3;
  return scan;
}

std::vector<LidarPoint> SamplePoints() {
  return {{{1.0f, -2.0f, 0.5f}, 255, 0, 0.1f},
          {{-131.068f, 131.068f, -0.004f}, 0, 2, 0.0f},
          {{20.0014f, 0.0f, 0.0026f}, 17, 1, 0.131070f}};
}

lidar_scan_t SampleScan() {
  lidar_scan_t scan = EmptyScan();
  PackPoints(SamplePoints(), scan);
  return scan;
}

std::string ProblemOf(const lidar_scan_t& scan) {
  std::vector<LidarPoint> points(7);
  const std::string problem(UnpackPoints(scan, points));
  EXPECT_TRUE(problem.empty() || points.empty());
  return problem;
}

TEST(Crc32c, AgreesWithThePublishedTestVectors) {
  // RFC 3720, B.4, and the check value of the CRC catalogues.
  const std::vector<uint8_t> zeros(32, 0x00);
  const std::vector<uint8_t> ones(32, 0xff);
  std::vector<uint8_t> rising(32);
  std::iota(rising.begin(), rising.end(), uint8_t{0});
  const std::string digits = "123456789";
  EXPECT_EQ(Crc32c(zeros.data(), 32), 0x8a9136aau);
  EXPECT_EQ(Crc32c(ones.data(), 32), 0x62a8ab43u);
  EXPECT_EQ(Crc32c(rising.data(), 32), 0x46dd794eu);
  EXPECT_EQ(Crc32c(reinterpret_cast<const uint8_t*>(digits.data()), 9), 0xe3069283u);
  EXPECT_EQ(Crc32c(nullptr, 0), 0u);
}

TEST(Crc32c, IsTheSameByTablesAtEveryLength) {
  std::vector<uint8_t> bytes(100);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i * i * 37 + 11);
  for (size_t from = 0; from < 9; ++from) {
    for (size_t size = 0; from + size <= bytes.size(); ++size)
      ASSERT_EQ(Crc32c(bytes.data() + from, size), Crc32cByTables(bytes.data() + from, size));
  }
}

TEST(LidarScan, GivesBackWhatWasPackedWithinHalfAStep) {
  std::vector<LidarPoint> points;
  ASSERT_EQ(UnpackPoints(SampleScan(), points), "");
  const std::vector<LidarPoint> expected = SamplePoints();
  ASSERT_EQ(points.size(), expected.size());
  for (size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(points[i].position[axis], expected[i].position[axis], 0.00201);
    EXPECT_EQ(points[i].intensity, expected[i].intensity);
    EXPECT_EQ(points[i].ring, expected[i].ring);
    EXPECT_NEAR(points[i].age, expected[i].age, 1.01e-6);
  }
}

TEST(LidarScan, HasTheLayoutThatTheMessageDocuments) {
  lidar_scan_t scan = EmptyScan();
  PackPoints(std::vector<LidarPoint>{{{0.004f, -0.008f, 1.024f}, 9, 2, 0.002f}}, scan);
  EXPECT_EQ(scan.points, (std::vector<uint8_t>{1, 0, 0xfe, 0xff, 0, 1, 9, 2, 0xe8, 3}));
  EXPECT_EQ(scan.num_points, 1);
  EXPECT_EQ(scan.num_bytes, 10);
}

TEST(LidarScan, OfNoPointsIsGood) {
  lidar_scan_t scan = EmptyScan();
  PackPoints({}, scan);
  EXPECT_EQ(ProblemOf(scan), "");
}

TEST(LidarScan, RefusesEveryFlippedBit) {
  const lidar_scan_t good = SampleScan();
  for (size_t bit = 0; bit < 8 * good.points.size(); ++bit) {
    lidar_scan_t scan = good;
    scan.points[bit / 8] = static_cast<uint8_t>(scan.points[bit / 8] ^ 1u << bit % 8);
    EXPECT_EQ(ProblemOf(scan), "checksum of the points is wrong") << bit;
  }
}

TEST(LidarScan, RefusesWhatContradictsItself) {
  const lidar_scan_t good = SampleScan();
  lidar_scan_t scan = good;
  scan.points.pop_back();
  EXPECT_EQ(ProblemOf(scan), "number of points and of bytes contradict each other");
  scan = good;
  scan.num_points = -1;
  EXPECT_EQ(ProblemOf(scan), "number of points and of bytes contradict each other");
  scan = good;
  scan.coordinate_step_m = 0.0;
  EXPECT_EQ(ProblemOf(scan), "coordinate_step_m cannot be");
  scan = good;
  scan.time_step_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ProblemOf(scan), "time_step_s cannot be");
  scan = good;
  scan.covered_share = 1.5;
  EXPECT_EQ(ProblemOf(scan), "covered_share cannot be");
  scan = good;
  scan.ring_elevation_rad = {0.1f, 0.0f, 0.2f};
  EXPECT_EQ(ProblemOf(scan), "elevations do not rise");
  scan = good;
  scan.ring_elevation_rad.clear();
  EXPECT_EQ(ProblemOf(scan), "no table of 1 to 256 rings");
  scan = good;
  scan.ring_elevation_rad.pop_back();
  EXPECT_EQ(ProblemOf(scan), "a ring that is not in the table");
}

TEST(LidarScan, ThrowsWhereAValueDoesNotFit) {
  lidar_scan_t scan = EmptyScan();
  const auto pack = [&scan](float x, float age) {
    PackPoints(std::vector<LidarPoint>{{{x, 0.0f, 0.0f}, 0, 0, age}}, scan);
  };
  EXPECT_THROW(pack(131.08f, 0.0f), std::invalid_argument);
  EXPECT_THROW(pack(std::numeric_limits<float>::quiet_NaN(), 0.0f), std::invalid_argument);
  EXPECT_THROW(pack(0.0f, 0.14f), std::invalid_argument);
  EXPECT_THROW(pack(0.0f, -1e-3f), std::invalid_argument);
  scan.time_step_s = 0.0;
  EXPECT_THROW(pack(0.0f, 0.0f), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
