#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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

  using Images = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Probabilities by class, a row for each image; an image is a row of two 32 x 32 planes.
  Images Run(const Images& images) const;

 private:
  struct Layer {
    Images weights;  // outputs x inputs
    Eigen::RowVectorXf bias;
  };
  std::vector<Layer> layers_;
};

}  // namespace hairpin
