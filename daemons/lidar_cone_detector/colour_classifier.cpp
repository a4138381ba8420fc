#include "daemons/lidar_cone_detector/colour_classifier.hpp"

#include <stdexcept>

#include "daemons/lidar_cone_detector/intensity_image.hpp"

namespace hairpin {

ColourClassifier::ColourClassifier(const ColourParams& params)
    : params_(params), net_(ColourNet::Shipped()) {
  if (params.min_returns < 1) throw std::invalid_argument("min_returns must be >= 1");
  if (!(params.percent_per_step > 0.0)) throw std::invalid_argument("percent_per_step must be > 0");
}

std::vector<ColourDistribution> ColourClassifier::Classify(
    std::span<const ConeReturns> cones) const {
  std::vector<ColourDistribution> colours(cones.size(), kColourUnknown);
  for (size_t i = 0; i < cones.size(); ++i) {
    if (cones[i].x.size() < static_cast<size_t>(params_.min_returns)) continue;
    const ColourNet::Classes classes =
        net_.Run(RenderIntensity(cones[i], static_cast<float>(params_.percent_per_step)));
    colours[i] = {classes[0], classes[1], classes[2], 0.0, 0.0};
  }
  return colours;
}

ColourParams LoadColourParams(const Config& config) {
  const Config colour = config.Section("colour");
  ColourParams params;
  params.min_returns = colour.Integer("min_returns", 1, 1000);
  params.percent_per_step = colour.Number("percent_per_step", {0.01, 100.0});
  return params;
}

}  // namespace hairpin
