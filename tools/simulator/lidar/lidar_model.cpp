#include "tools/simulator/lidar/lidar_model.hpp"

#include <numbers>

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Row {
  double elevation_deg;
  double azimuth_offset_deg;
};

constexpr Row kVlp32c[32] = {
    {-25.0, 1.4},  {-1.0, -4.2},   {-1.667, 1.4}, {-15.639, -1.4}, {-11.31, 1.4}, {0.0, -1.4},
    {-0.667, 4.2}, {-8.843, -1.4}, {-7.254, 1.4}, {0.333, -4.2},   {-0.333, 1.4}, {-6.148, -1.4},
    {-5.333, 4.2}, {1.333, -1.4},  {0.667, 4.2},  {-4.0, -1.4},    {-4.667, 1.4}, {1.667, -4.2},
    {1.0, 1.4},    {-3.667, -4.2}, {-3.333, 4.2}, {3.333, -1.4},   {2.333, 1.4},  {-2.667, -1.4},
    {-3.0, 1.4},   {7.0, -1.4},    {4.667, 1.4},  {-2.333, -4.2},  {-2.0, 4.2},   {15.0, -1.4},
    {10.333, 1.4}, {-1.333, -1.4}};
constexpr int64_t kPairNs = 2304;  // two lasers fire together, pair after pair

}  // namespace

LidarModel Vlp32c() {
  LidarModel model{"VLP-32C", {}, 24 * kPairNs};  // 16 pairs, then the time of 8 for recharging
  for (int64_t channel = 0; channel < 32; ++channel) {
    const Row& row = kVlp32c[channel];
    model.lasers.push_back(
        {row.elevation_deg * kDegree, row.azimuth_offset_deg * kDegree, channel / 2 * kPairNs});
  }
  return model;
}

}  // namespace hairpin
