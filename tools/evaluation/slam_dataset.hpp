#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemons/global_mapper/factors.hpp"

namespace hairpin {

/// A landmark-SLAM benchmark with known associations, in the order of the drive.
struct SlamDataset {
  struct Sighting {
    size_t landmark;  // numbered from 0 in the order of first sightings
    LandmarkMeasurement measurement;
    // Of (bearing [rad], range [m]) where these are what was measured; their covariance in x, y is
    // `measurement`'s then.
    std::optional<Eigen::Vector2d> polar_sigma;
  };
  struct Step {
    OdometryMeasurement odometry;  // from the step before; the first step's is not used
    std::vector<Sighting> sightings;
  };
  std::vector<Step> steps;
  size_t num_landmarks = 0;
};

/// How the file's numbers after a measurement are read.
///
/// kBearingRange: odometry's as the upper triangle of its covariance, row by row; a landmark's equal
/// variances v of x and y as those at 10 m, which make sigma sqrt(v / 10) of its bearing [rad] and
/// sqrt(v) of its range [m], both measured. So does GTSAM's load2D [Dellaert 2012], by which the
/// known figures of Victoria Park were made. kCovariance and kInformation: of x, y as they stand.
enum class NoiseReading { kBearingRange, kCovariance, kInformation };

/// Reads lines `ODOMETRY i j dx dy dyaw` and `LANDMARK i j x y` with 6 and 3 noise figures; ids are
/// shared by poses and landmarks, each odometry goes on from the newest pose, and landmarks are
/// seen from it. Throws RecordingError "file:line: reason".
SlamDataset LoadSlamDataset(const std::string& file, NoiseReading reading);

}  // namespace hairpin
