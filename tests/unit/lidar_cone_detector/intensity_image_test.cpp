#include "daemons/lidar_cone_detector/intensity_image.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hairpin {
namespace {

constexpr size_t kPlane = size_t{kImageSize} * kImageSize;

void AddReturn(ConeReturns& cone, float right, float height, uint8_t intensity) {
  const Eigen::Vector2f sight = cone.axis.normalized();
  cone.x.push_back(cone.axis.x() + sight.y() * right);
  cone.y.push_back(cone.axis.y() - sight.x() * right);
  cone.z.push_back(height);
  cone.age.push_back(0.0f);
  cone.intensity.push_back(intensity);
}

ConeReturns SomeCone(const Eigen::Vector2f& axis) {
  ConeReturns cone;
  cone.axis = axis;
  AddReturn(cone, -0.05f, 0.10f, 60);
  AddReturn(cone, 0.08f, 0.20f, 10);
  AddReturn(cone, 0.0f, 0.30f, 70);
  return cone;
}

TEST(IntensityImage, PutsAReturnWhereItIsSeenFromBase) {
  ConeReturns cone;
  cone.axis = {8.0f, 3.0f};
  AddReturn(cone, 0.14f, 0.28f, 50);
  const IntensityImage image = RenderIntensity(cone, 1.0f);
  // A quarter of the width right of the middle, half of the height up.
  const size_t pixel = 16 * kImageSize + 24;
  EXPECT_GT(image[kPlane + pixel], 0.8f);
  EXPECT_NEAR(image[pixel], 0.5f * image[kPlane + pixel], 1e-5f);
  EXPECT_EQ(image[kPlane + 16 * kImageSize + 8], 0.0f);
}

TEST(IntensityImage, StaysTheSameWhereverTheConeStands) {
  const IntensityImage ahead = RenderIntensity(SomeCone({9.0f, 0.0f}), 1.0f);
  const IntensityImage aside = RenderIntensity(SomeCone({-2.0f, 6.0f}), 1.0f);
  for (size_t i = 0; i < ahead.size(); ++i) ASSERT_NEAR(ahead[i], aside[i], 1e-3f) << i;
}

TEST(IntensityImage, IsEmptyWithoutReturnsAndWithReturnsFarOff) {
  ConeReturns cone;
  cone.axis = {5.0f, 0.0f};
  EXPECT_EQ(RenderIntensity(cone, 1.0f), IntensityImage{});
  AddReturn(cone, 40.0f, 0.1f, 50);
  AddReturn(cone, 0.0f, 1e9f, 50);
  EXPECT_EQ(RenderIntensity(cone, 1.0f), IntensityImage{});
}

TEST(IntensityImage, ScalesTheByteAndBoundsReflectors) {
  ConeReturns cone;
  cone.axis = {5.0f, 0.0f};
  AddReturn(cone, 0.0f, 0.2f, 200);
  const IntensityImage percent = RenderIntensity(cone, 0.25f);
  const IntensityImage bright = RenderIntensity(cone, 1.0f);
  for (size_t i = 0; i < kPlane; ++i) {
    ASSERT_NEAR(percent[i], 0.5f * percent[kPlane + i], 1e-5f);
    ASSERT_NEAR(bright[i], 1.5f * bright[kPlane + i], 1e-5f);
  }
}

}  // namespace
}  // namespace hairpin
