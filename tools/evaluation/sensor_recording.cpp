#include "tools/evaluation/sensor_recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace hairpin {
namespace {

constexpr double kMoves = 1.0;  // m/s

using Row = std::vector<double>;

[[noreturn]] void Fail(const std::string& file, size_t line, const std::string& why) {
  throw RecordingError(file + ":" + std::to_string(line) + ": " + why);
}

double ReadNumber(const std::string& text, const std::string& file, size_t line) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    Fail(file, line, "'" + text + "' is no finite number");
  return value;
}

Row ReadRow(const std::string& text, size_t columns, const std::string& file, size_t line) {
  Row row;
  std::istringstream cells(text);
  for (std::string cell; std::getline(cells, cell, ',');)
    row.push_back(ReadNumber(cell, file, line));
  if (row.size() != columns) Fail(file, line, "must have " + std::to_string(columns) + " columns");
  return row;
}

std::vector<Row> ReadRows(const std::string& file, size_t columns) {
  std::ifstream stream(file);
  std::string text;
  if (!stream || !std::getline(stream, text)) throw RecordingError(file + ": cannot be read");
  std::vector<Row> rows;
  for (size_t line = 2; std::getline(stream, text); ++line) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (!text.empty()) rows.push_back(ReadRow(text, columns, file, line));
  }
  if (rows.empty()) throw RecordingError(file + ": has no rows");
  return rows;
}

int64_t UtimeOf(const Row& row) { return static_cast<int64_t>(std::llround(row[0] * 1e6)); }

template <class Reading>
void Append(std::vector<Reading>& readings, const Reading& reading) {
  if (readings.empty() || reading.utime > readings.back().utime) readings.push_back(reading);
}

}  // namespace

SensorRecording LoadSensorRecording(const std::string& folder, const RecordingScale& scale) {
  SensorRecording recording;
  for (const Row& row : ReadRows(folder + "/imu_200hz.csv", 7))
    Append(recording.imu, ImuReading{UtimeOf(row), {row[4], row[5]}, row[3]});
  for (const Row& row : ReadRows(folder + "/optical_speed_250hz.csv", 3))
    Append(recording.ground_speed, GroundSpeedReading{UtimeOf(row), {row[1], row[2]}});
  const double rpm_per_radps = scale.motor_rpm_per_mps * scale.wheel_radius;
  for (const Row& row : ReadRows(folder + "/wheel_rpm_100hz.csv", 5)) {
    MotorsReading reading{UtimeOf(row), {}, std::nullopt};
    for (size_t i = 0; i < 4; ++i) reading.speed[i] = row[i + 1] / rpm_per_radps;
    Append(recording.motors, reading);
  }
  std::optional<LocalEnu> plane;
  for (const Row& row : ReadRows(folder + "/gps_10hz.csv", 3)) {
    const GeodeticPoint point{row[1], row[2], 0.0};
    if (!plane) plane.emplace(point);
    Append(recording.gps, GpsFix{UtimeOf(row), plane->ToEnu(point).head<2>()});
  }
  return recording;
}

Drive DriveOf(const SensorRecording& recording, double wheel_radius) {
  std::optional<Drive> drive;
  for (const MotorsReading& reading : recording.motors) {
    // The second slowest wheel: one may lock, one may spin.
    Wheels speeds = reading.speed;
    std::sort(speeds.begin(), speeds.end());
    if (speeds[1] * wheel_radius < kMoves) continue;
    if (!drive) drive = Drive{reading.utime, reading.utime};
    drive->to = reading.utime;
  }
  if (!drive) throw RecordingError("the car never moves in this recording");
  return *drive;
}

}  // namespace hairpin
