#pragma once

#include <string>
#include <vector>

#include "daemons/global_mapper/factors.hpp"

namespace hairpin {

/// A landmark-SLAM benchmark with known associations, in the order of the drive.
struct SlamDataset {
  struct Sighting {
    size_t landmark;  // numbered from 0 in the order of first sightings
    LandmarkMeasurement measurement;
  };
  struct Step {
    OdometryMeasurement odometry;  // from the step before; the first step's is not used
    std::vector<Sighting> sightings;
  };
  std::vector<Step> steps;
  size_t num_landmarks = 0;
};

/// How the file's numbers after a measurement are read: as the upper triangle of its information
/// matrix, row by row, or of its covariance.
enum class NoiseReading { kInformation, kCovariance };

/// Reads lines `ODOMETRY i j dx dy dyaw` and `LANDMARK i j x y` with 6 and 3 noise figures; ids are
/// shared by poses and landmarks, each odometry goes on from the newest pose, and landmarks are
/// seen from it. Throws RecordingError "file:line: reason".
SlamDataset LoadSlamDataset(const std::string& file, NoiseReading reading);

}  // namespace hairpin
