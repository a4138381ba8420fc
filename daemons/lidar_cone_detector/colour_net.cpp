#include "daemons/lidar_cone_detector/colour_net.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hairpin {
namespace {

constexpr float kShippedWeights[] = {
#include "daemons/lidar_cone_detector/colour_weights.inc"
};

struct Convolution {
  int planes_in;
  int planes_out;
  int size_in;  // pixels along an edge; half of it comes out
};
constexpr std::array<Convolution, 3> kConvolutions{{{2, 8, 32}, {8, 16, 16}, {16, 16, 8}}};
struct Dense {
  int in;
  int out;
};
constexpr std::array<Dense, 2> kDense{{{256, 32}, {32, ColourNet::kClasses}}};
constexpr int kKernel = 3;

using Images = ColourNet::Images;

// The inputs of each output pixel as a row: (image, row, column) x (plane, kernel row, kernel
// column), zero beyond the edge. Images are rows of planes.
void Unfold(const Images& images, const Convolution& layer, Images& patches) {
  const int size = layer.size_in;
  const int half = size / 2;
  patches.setZero(images.rows() * half * half, layer.planes_in * kKernel * kKernel);
  Eigen::Index patch = 0;
  for (Eigen::Index image = 0; image < images.rows(); ++image) {
    for (int row = 0; row < half; ++row) {
      for (int column = 0; column < half; ++column, ++patch) {
        float* out = patches.row(patch).data();
        for (int plane = 0; plane < layer.planes_in; ++plane) {
          const float* in = images.row(image).data() + plane * size * size;
          for (int dr = 0; dr < kKernel; ++dr) {
            for (int dc = 0; dc < kKernel; ++dc, ++out) {
              const int r = 2 * row + dr - 1;
              const int c = 2 * column + dc - 1;
              if (r >= 0 && r < size && c >= 0 && c < size) *out = in[r * size + c];
            }
          }
        }
      }
    }
  }
}

// From (image, row, column) x plane back to image x (plane, row, column).
void Fold(const Images& pixels, Eigen::Index num_images, Images& images) {
  const Eigen::Index area = pixels.rows() / num_images;
  images.resize(num_images, area * pixels.cols());
  for (Eigen::Index image = 0; image < num_images; ++image) {
    Eigen::Map<Images>(images.row(image).data(), pixels.cols(), area) =
        pixels.middleRows(image * area, area).transpose();
  }
}

void Softmax(Images& logits) {
  for (Eigen::Index row = 0; row < logits.rows(); ++row) {
    const float highest = logits.row(row).maxCoeff();
    float sum = 0.0f;
    for (Eigen::Index i = 0; i < logits.cols(); ++i) {
      logits(row, i) = std::exp(logits(row, i) - highest);
      sum += logits(row, i);
    }
    logits.row(row) /= sum;
  }
}

}  // namespace

size_t ColourNet::NumWeights() {
  int count = 0;
  for (const Convolution& layer : kConvolutions)
    count += layer.planes_out * (layer.planes_in * kKernel * kKernel + 1);
  for (const Dense& layer : kDense) count += layer.out * (layer.in + 1);
  return static_cast<size_t>(count);
}

ColourNet::ColourNet(std::span<const float> weights) {
  if (weights.size() != NumWeights()) {
    throw std::invalid_argument("ColourNet takes " + std::to_string(NumWeights()) +
                                " weights, not " + std::to_string(weights.size()));
  }
  const float* next = weights.data();
  const auto add = [&](int outputs, int inputs) {
    Layer layer;
    layer.weights = Eigen::Map<const Images>(next, outputs, inputs);
    next += outputs * inputs;
    layer.bias = Eigen::Map<const Eigen::RowVectorXf>(next, outputs);
    next += outputs;
    layers_.push_back(std::move(layer));
  };
  for (const Convolution& layer : kConvolutions)
    add(layer.planes_out, layer.planes_in * kKernel * kKernel);
  for (const Dense& layer : kDense) add(layer.out, layer.in);
}

ColourNet ColourNet::Shipped() { return ColourNet(kShippedWeights); }

ColourNet::Images ColourNet::Run(const Images& images) const {
  Images values = images;
  Images patches;
  Images pixels;
  for (size_t i = 0; i < kConvolutions.size(); ++i) {
    Unfold(values, kConvolutions[i], patches);
    pixels.noalias() = patches * layers_[i].weights.transpose();
    pixels.rowwise() += layers_[i].bias;
    pixels = pixels.cwiseMax(0.0f);
    Fold(pixels, images.rows(), values);
  }
  for (size_t i = kConvolutions.size(); i < layers_.size(); ++i) {
    if (i > kConvolutions.size()) values = values.cwiseMax(0.0f).eval();
    pixels.noalias() = values * layers_[i].weights.transpose();
    pixels.rowwise() += layers_[i].bias;
    values = pixels;
  }
  Softmax(values);
  return values;
}

}  // namespace hairpin
