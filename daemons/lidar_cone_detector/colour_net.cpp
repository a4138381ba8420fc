#include "daemons/lidar_cone_detector/colour_net.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hairpin {
namespace {

constexpr float kShippedWeights[] = {
#include "daemons/lidar_cone_detector/colour_weights.inc"
};

constexpr size_t kKernel = 3;
constexpr size_t kHidden = 32;
constexpr size_t kClassCount = ColourNet::kClasses;

/// A convolution of stride 2: its planes, and the pixels along an edge that go in; half come out.
struct Convolution {
  size_t planes_in;
  size_t planes_out;
  size_t size_in;
};
constexpr Convolution kFirst{2, 8, 32};
constexpr Convolution kSecond{8, 16, 16};
constexpr Convolution kThird{16, 16, 8};
constexpr size_t kFlat = kThird.planes_out * kThird.size_in / 2 * kThird.size_in / 2;

constexpr size_t InputsOf(const Convolution& layer) { return layer.planes_in * kKernel * kKernel; }
constexpr size_t OutputValues(const Convolution& layer) {
  return layer.planes_out * layer.size_in / 2 * layer.size_in / 2;
}
constexpr size_t CountOf(size_t inputs, size_t outputs) { return outputs * (inputs + 1); }

// sums += value * weights. Most values are zero: beside the cone, and where a rectifier cut.
template <size_t kOutputs>
void AddScaled(float value, const float* weights, std::array<float, kOutputs>& sums) {
  if (value == 0.0f) return;
  for (size_t o = 0; o < kOutputs; ++o) sums[o] += value * weights[o];
}

template <size_t kOutputs>
std::array<float, kOutputs> BiasOf(const ColourNet::Layer& layer) {
  std::array<float, kOutputs> sums;
  std::copy(layer.bias.begin(), layer.bias.end(), sums.begin());
  return sums;
}

// Values lie as (row, column, plane). The image goes on with zeros beyond its edge.
template <Convolution kLayer>
std::array<float, OutputValues(kLayer)> Convolve(const float* in, const ColourNet::Layer& layer) {
  constexpr size_t kSize = kLayer.size_in;
  std::array<float, OutputValues(kLayer)> out;
  float* next = out.data();
  for (size_t row = 0; row < kSize; row += 2) {
    for (size_t column = 0; column < kSize; column += 2) {
      auto sums = BiasOf<kLayer.planes_out>(layer);
      const float* weights = layer.weights.data();
      for (size_t r = row; r < row + kKernel; ++r) {
        for (size_t c = column; c < column + kKernel; ++c) {
          // r and c are one ahead of the pixel.
          const bool inside = r >= 1 && r <= kSize && c >= 1 && c <= kSize;
          const float* pixel = in + (inside ? (r - 1) * kSize + c - 1 : 0) * kLayer.planes_in;
          for (size_t i = 0; i < kLayer.planes_in; ++i, weights += kLayer.planes_out) {
            if (inside) AddScaled(pixel[i], weights, sums);
          }
        }
      }
      for (const float sum : sums) *next++ = std::max(sum, 0.0f);
    }
  }
  return out;
}

template <size_t kInputs, size_t kOutputs>
std::array<float, kOutputs> Connect(const std::array<float, kInputs>& in,
                                    const ColourNet::Layer& layer) {
  auto sums = BiasOf<kOutputs>(layer);
  for (size_t i = 0; i < kInputs; ++i) AddScaled(in[i], layer.weights.data() + i * kOutputs, sums);
  return sums;
}

// The file has (output, plane, pixel), we (pixel, plane, output).
ColourNet::Layer Reordered(const float* weights, size_t outputs, size_t planes, size_t pixels) {
  ColourNet::Layer layer;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    for (size_t plane = 0; plane < planes; ++plane) {
      for (size_t output = 0; output < outputs; ++output)
        layer.weights.push_back(weights[(output * planes + plane) * pixels + pixel]);
    }
  }
  const float* bias = weights + outputs * planes * pixels;
  layer.bias.assign(bias, bias + outputs);
  return layer;
}

ColourNet::Classes Softmax(const ColourNet::Classes& logits) {
  const float highest = *std::max_element(logits.begin(), logits.end());
  ColourNet::Classes classes;
  float sum = 0.0f;
  for (size_t i = 0; i < classes.size(); ++i) sum += classes[i] = std::exp(logits[i] - highest);
  for (float& value : classes) value /= sum;
  return classes;
}

}  // namespace

size_t ColourNet::NumWeights() {
  size_t count = CountOf(kFlat, kHidden) + CountOf(kHidden, kClassCount);
  for (const Convolution& layer : {kFirst, kSecond, kThird})
    count += CountOf(InputsOf(layer), layer.planes_out);
  return count;
}

ColourNet::ColourNet(std::span<const float> weights) {
  if (weights.size() != NumWeights()) {
    throw std::invalid_argument("ColourNet takes " + std::to_string(NumWeights()) +
                                " weights, not " + std::to_string(weights.size()));
  }
  const float* next = weights.data();
  const auto add = [&](size_t outputs, size_t planes, size_t pixels) {
    layers_.push_back(Reordered(next, outputs, planes, pixels));
    next += CountOf(planes * pixels, outputs);
  };
  for (const Convolution& layer : {kFirst, kSecond, kThird})
    add(layer.planes_out, layer.planes_in, kKernel * kKernel);
  add(kHidden, kThird.planes_out, kFlat / kThird.planes_out);
  add(kClassCount, kHidden, 1);
}

ColourNet ColourNet::Shipped() { return ColourNet(kShippedWeights); }

ColourNet::Classes ColourNet::Run(const IntensityImage& image) const {
  constexpr size_t kPlane = kFirst.size_in * kFirst.size_in;
  IntensityImage pixels;
  for (size_t i = 0; i < kPlane; ++i) {
    pixels[2 * i] = image[i];
    pixels[2 * i + 1] = image[kPlane + i];
  }
  const auto first = Convolve<kFirst>(pixels.data(), layers_[0]);
  const auto second = Convolve<kSecond>(first.data(), layers_[1]);
  const auto third = Convolve<kThird>(second.data(), layers_[2]);
  auto hidden = Connect<kFlat, kHidden>(third, layers_[3]);
  for (float& value : hidden) value = std::max(value, 0.0f);
  return Softmax(Connect<kHidden, kClassCount>(hidden, layers_[4]));
}

}  // namespace hairpin
