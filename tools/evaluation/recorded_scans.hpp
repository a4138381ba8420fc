#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/cone.hpp"
#include "common/geometry.hpp"

namespace hairpin {

/// One scan of a recorded drive (FSCN): points in base at its time, already deskewed.
struct RecordedScan {
  double time = 0.0;  // s since the epoch
  Pose2 T_map_base;   // the recorder's own estimate
  Twist2 velocity;
  std::vector<float> x, y, z;  // base [m]
  std::vector<uint8_t> intensity;
};

/// Reads a recording of LiDAR scans: a .xz file of little-endian records "FSCN", seven float64
/// (t_s, map_x_m, map_y_m, map_yaw_rad, vx_mps, vy_mps, yaw_rate_radps), uint32 n, int16 x[n],
/// y[n], z[n] in mm, uint8 intensity[n]. Unpacks as it goes: memory is bounded by the largest scan.
class RecordedScanReader {
 public:
  /// Throws RecordingError where the file cannot be read.
  explicit RecordedScanReader(const std::string& file);
  ~RecordedScanReader();

  /// The next scan, empty at the end. Throws RecordingError: no xz, a damaged record, a number that
  /// is not finite, more than kMaxPoints points, times that do not increase.
  std::optional<RecordedScan> Next();

  static constexpr uint32_t kMaxPoints = 1'000'000;

 private:
  class Decompressor;
  [[noreturn]] void Fail(const std::string& why) const;

  std::string file_;
  std::unique_ptr<Decompressor> bytes_;
  int64_t scans_ = 0;
  double last_time_ = 0.0;
};

/// A surveyed cone.
struct SurveyedCone {
  Eigen::Vector2d position;  // map [m]
  ConeColour colour;
};

/// Reads a map: a CSV file with the header x_m,y_m,colour and names of colours as NameOf() writes
/// them. Throws RecordingError.
std::vector<SurveyedCone> LoadSurveyedMap(const std::string& file);

}  // namespace hairpin
