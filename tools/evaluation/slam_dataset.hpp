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

/// How the file's numbers after a measurement are read: as the upper triangle, row by row, of its
/// information matrix or of its covariance.
///
/// kBearingRange: covariances; but a landmark's equal variances v of x and y are those at 10 m,
/// which makes sigma sqrt(v / 10) of its bearing [rad] and sqrt(v) of its range [m], both taken as
/// measured. So does GTSAM's load2D [Dellaert 2012].
///
/// Victoria Park has a least cost of 0.08 by kInformation, 2339 by kBearingRange and 3092 by
/// kCovariance. Which of them the 110 belongs to that is told of iSAM2 is not known: it is a
/// minimum of none.
enum class NoiseReading { kInformation, kCovariance, kBearingRange };

/// Reads lines `ODOMETRY i j dx dy dyaw` and `LANDMARK i j x y` with 6 and 3 noise figures; ids are
/// shared by poses and landmarks, each odometry goes on from the newest pose, and landmarks are
/// seen from it. Throws RecordingError "file:line: reason".
SlamDataset LoadSlamDataset(const std::string& file, NoiseReading reading);

}  // namespace hairpin
