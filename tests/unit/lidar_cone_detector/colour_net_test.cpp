#include "daemons/lidar_cone_detector/colour_net.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "daemons/lidar_cone_detector/colour_classifier.hpp"

namespace hairpin {
namespace {

std::vector<float> RandomNumbers(size_t count, float scale) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(-scale, scale);
  std::vector<float> numbers(count);
  for (float& number : numbers) number = uniform(engine);
  return numbers;
}

// A convolution by its definition, on planes behind one another.
std::vector<double> Convolve(const std::vector<double>& in, int planes_in, int planes_out, int size,
                             const float*& weights) {
  const int half = size / 2;
  std::vector<double> out(static_cast<size_t>(planes_out * half * half));
  const float* bias = weights + planes_out * planes_in * 9;
  for (int p = 0; p < planes_out; ++p) {
    for (int r = 0; r < half; ++r) {
      for (int c = 0; c < half; ++c) {
        double sum = bias[p];
        for (int q = 0; q < planes_in; ++q) {
          for (int k = 0; k < 9; ++k) {
            const int row = 2 * r + k / 3 - 1;
            const int column = 2 * c + k % 3 - 1;
            if (row < 0 || row >= size || column < 0 || column >= size) continue;
            sum += weights[(p * planes_in + q) * 9 + k] *
                   in[static_cast<size_t>((q * size + row) * size + column)];
          }
        }
        out[static_cast<size_t>((p * half + r) * half + c)] = std::max(sum, 0.0);
      }
    }
  }
  weights = bias + planes_out;
  return out;
}

std::vector<double> Connect(const std::vector<double>& in, int outputs, const float*& weights) {
  std::vector<double> out(static_cast<size_t>(outputs));
  const auto inputs = static_cast<int>(in.size());
  for (int o = 0; o < outputs; ++o) {
    out[static_cast<size_t>(o)] = weights[outputs * inputs + o];
    for (int i = 0; i < inputs; ++i)
      out[static_cast<size_t>(o)] += weights[o * inputs + i] * in[static_cast<size_t>(i)];
  }
  weights += outputs * (inputs + 1);
  return out;
}

TEST(ColourNet, AgreesWithALayerByLayerReference) {
  const std::vector<float> weights = RandomNumbers(ColourNet::NumWeights(), 0.3f);
  const std::vector<float> pixels = RandomNumbers(3 * 2048, 1.0f);
  const ColourNet net(weights);
  for (int image = 0; image < 3; ++image) {
    IntensityImage input;
    std::copy_n(pixels.begin() + image * 2048, 2048, input.begin());
    const ColourNet::Classes classes = net.Run(input);
    const float* next = weights.data();
    std::vector<double> values(pixels.begin() + image * 2048, pixels.begin() + (image + 1) * 2048);
    values = Convolve(values, 2, 8, 32, next);
    values = Convolve(values, 8, 16, 16, next);
    values = Convolve(values, 16, 16, 8, next);
    values = Connect(values, 32, next);
    for (double& value : values) value = std::max(value, 0.0);
    values = Connect(values, 3, next);
    double sum = 0.0;
    for (double& value : values) sum += value = std::exp(value);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(classes[i], values[i] / sum, 1e-4);
  }
}

TEST(ColourNet, RefusesAnotherNumberOfWeights) {
  EXPECT_THROW(ColourNet(RandomNumbers(ColourNet::NumWeights() - 1, 1.0f)), std::invalid_argument);
}

TEST(ColourClassifier, CallsAConeWithTooFewReturnsUnknown) {
  ConeReturns cone;
  cone.axis = {5.0f, 0.0f};
  for (const float height : {0.1f, 0.3f}) {
    cone.x.push_back(5.0f);
    cone.y.push_back(0.0f);
    cone.z.push_back(height);
    cone.age.push_back(0.0f);
    cone.intensity.push_back(60);
  }
  const ColourClassifier classifier({3, 1.0});
  EXPECT_EQ(classifier.Classify(std::vector{cone})[0], kColourUnknown);
  EXPECT_TRUE(classifier.Classify({}).empty());
}

TEST(ColourClassifier, GivesEachConeTheSameColourAloneAsAmongOthers) {
  std::vector<ConeReturns> cones(5);
  for (size_t i = 0; i < cones.size(); ++i) {
    cones[i].axis = {6.0f + static_cast<float>(i), 1.0f};
    for (int k = 0; k < 12; ++k) {
      cones[i].x.push_back(cones[i].axis.x());
      cones[i].y.push_back(cones[i].axis.y() + 0.01f * static_cast<float>(k % 3));
      cones[i].z.push_back(0.05f + 0.02f * static_cast<float>(k));
      cones[i].age.push_back(0.0f);
      cones[i].intensity.push_back(static_cast<uint8_t>((k * 37 + 11 * static_cast<int>(i)) % 90));
    }
  }
  const ColourClassifier classifier({3, 1.0});
  const std::vector<ColourDistribution> together = classifier.Classify(cones);
  for (size_t i = 0; i < cones.size(); ++i) {
    const ColourDistribution alone = classifier.Classify(std::span(&cones[i], 1))[0];
    for (size_t c = 0; c < alone.size(); ++c) EXPECT_NEAR(alone[c], together[i][c], 1e-5);
    EXPECT_NEAR(alone[0] + alone[1] + alone[2], 1.0, 1e-6);
  }
}

TEST(ColourClassifier, RefusesParametersThatCannotBe) {
  EXPECT_THROW(ColourClassifier({0, 1.0}), std::invalid_argument);
  EXPECT_THROW(ColourClassifier({3, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
