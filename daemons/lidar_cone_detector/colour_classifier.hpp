#pragma once

#include <span>
#include <vector>

#include "common/cone.hpp"
#include "common/config.hpp"
#include "daemons/lidar_cone_detector/colour_net.hpp"
#include "daemons/lidar_cone_detector/cone_returns.hpp"

namespace hairpin {

struct ColourParams {
  int min_returns = 0;            // a cone with fewer stays unknown
  double percent_per_step = 0.0;  // of the intensity byte, for diffuse targets
};

/// Colour from the pattern of intensities over a cone's height [paper III-B, LiDAR only]: yellow is
/// bright-dark-bright, blue dark-bright-dark. Anything else is unknown, orange cones too.
class ColourClassifier {
 public:
  /// Throws std::invalid_argument for values that cannot be.
  explicit ColourClassifier(const ColourParams& params);
  /// One distribution for each cone.
  std::vector<ColourDistribution> Classify(std::span<const ConeReturns> cones) const;

 private:
  ColourParams params_;
  ColourNet net_;
};

/// Reads the section `colour` of lidar_cone_detector.yaml. Problems are collected in `config`.
ColourParams LoadColourParams(const Config& config);

}  // namespace hairpin
