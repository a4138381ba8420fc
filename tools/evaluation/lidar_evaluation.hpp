#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "common/cone.hpp"
#include "daemons/lidar_cone_detector/lidar_cone_detector.hpp"

namespace hairpin {

/// A true cone in base, and what the sensor had of it.
struct ScannedCone {
  Eigen::Vector2d position;
  ConeColour colour = ConeColour::kUnknown;
  int returns = 0;  // more than kCountedHeight above the ground within kCountedRadius
};

struct LidarDetection {
  Eigen::Vector2d position;
  ColourDistribution colour = kColourUnknown;
};

inline constexpr float kCountedHeight = 0.06f;  // m
inline constexpr float kCountedRadius = 0.3f;   // m
inline constexpr double kMatchDistance = 0.5;   // m: farther from every true cone is false
inline constexpr int kFewestReturns = 3;        // of a cone that counts for recall

/// Counts the returns of each cone in the cloud. The ground is taken from the points about each
/// cone, so that the figure does not depend on what is measured by it.
void CountReturns(const PointCloud& cloud, std::vector<ScannedCone>& cones);

/// What one scan came to. Indices of the partner, -1 for none.
struct ScanMatch {
  std::vector<int> detection_of_cone;
  std::vector<int> cone_of_detection;  // -1: no cone at all within kMatchDistance; -2: one, but
                                       // taken by a nearer detection
};

/// Nearest pairs first, one to one.
ScanMatch MatchScan(const std::vector<ScannedCone>& cones,
                    const std::vector<LidarDetection>& detections);

/// Adds up scans and tells the figures.
class LidarFigures {
 public:
  /// `sensor`: its place in base, for errors along and across the line of sight. `ms`: wall time of
  /// each stage, and of the whole last.
  void Add(const std::vector<ScannedCone>& cones, const std::vector<LidarDetection>& detections,
           const Eigen::Vector2d& sensor, const std::vector<double>& ms);
  nlohmann::json ToJson() const;

 private:
  struct Seen {
    double range;
    int returns;
    bool found;
    ConeColour colour;
    double along = 0.0, across = 0.0;  // detection - cone, away from the sensor and to its left [m]
    ColourDistribution detected = kColourUnknown;
  };
  struct Reported {
    double range;
    bool in_view;
    bool is_false;
  };
  nlohmann::json RangeBin(double from, double to) const;
  nlohmann::json ByReturns() const;
  /// Blue and yellow cones found, by the paper's bins of range.
  struct ColourBins {
    nlohmann::json accuracy = nlohmann::json::array();  // of those that were called a colour
    nlohmann::json unknown = nlohmann::json::array();   // share of all that were not
  };
  ColourBins Colours() const;
  nlohmann::json ScansToLookAt() const;
  std::optional<double> Recall(double from, double to) const;
  std::optional<double> Precision(double to, bool everywhere) const;

  struct Trouble {
    int scan;
    int missed;  // cones that count for recall within 15 m
    int wrong;   // false detections within 15 m, in view
  };

  int scans_ = 0;
  std::vector<Trouble> troubles_;
  std::vector<Seen> seen_;
  std::vector<Reported> reported_;
  std::vector<std::vector<double>> ms_;
};

}  // namespace hairpin
