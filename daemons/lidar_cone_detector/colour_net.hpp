#pragma once

#include <array>
#include <span>
#include <vector>

#include "daemons/lidar_cone_detector/intensity_image.hpp"

namespace hairpin {

/// The small convolutional net that tells a cone's colour from its intensity image: three 3 x 3
/// convolutions with stride 2 (2 -> 8 -> 16 -> 16 planes), two fully connected layers (256 -> 32
/// -> 3), rectifiers between. Batch normalisation is folded into the convolutions by the training.
/// In single precision without fused operations, so that every machine says the same.
class ColourNet {
 public:
  static constexpr int kClasses = 3;  // unknown, blue, yellow
  /// Number of weights of all layers together.
  static size_t NumWeights();
  /// Weights of each layer in turn, outputs as rows of (input plane, row, column), then its biases:
  /// what tools/train/lidar_colour writes. Throws std::invalid_argument for another number.
  explicit ColourNet(std::span<const float> weights);
  /// The net that is shipped.
  static ColourNet Shipped();

  using Classes = std::array<float, kClasses>;
  /// Probabilities by class.
  Classes Run(const IntensityImage& image) const;

  /// For the implementation: weights by input, then by output.
  struct Layer {
    std::vector<float> weights;
    std::vector<float> bias;
  };

 private:
  std::vector<Layer> layers_;
};

}  // namespace hairpin
