#include "daemons/lidar_cone_detector/cone_fit.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace hairpin {
namespace {

constexpr int kIterations = 5;

Eigen::Vector2f FirstGuess(std::span<const ConeReturn> returns, const Eigen::Vector2f& sensor,
                           const ConeBody& shape) {
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  float radius = 0.0f;
  for (const ConeReturn& point : returns) {
    mean += point.position;
    radius += shape.RadiusAt(point.height);
  }
  const auto n = static_cast<float>(returns.size());
  mean /= n;
  const float behind = 0.25f * std::numbers::pi_v<float> * radius / n;
  return mean + behind * (mean - sensor).normalized();
}

}  // namespace

ConeFit FitCone(std::span<const ConeReturn> returns, const Eigen::Vector2f& sensor,
                const ConeBody& shape, const ConeFitParams& params) {
  const Eigen::Vector2f guess = FirstGuess(returns, sensor, shape);
  const float prior = static_cast<float>(std::pow(params.range_sigma / params.prior_sigma, 2));
  ConeFit fit{guess, 0.0f};
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2f normal = prior * Eigen::Matrix2f::Identity();
    Eigen::Vector2f right = prior * (guess - fit.axis);
    for (const ConeReturn& point : returns) {
      const Eigen::Vector2f from_axis = point.position - fit.axis;
      const float distance = std::max(from_axis.norm(), 1e-4f);
      const Eigen::Vector2f direction = from_axis / distance;
      // d(|p - c| - radius)/dc = -direction
      normal += direction * direction.transpose();
      right += direction * (distance - shape.RadiusAt(point.height));
    }
    fit.axis += normal.inverse() * right;
  }
  float sum = 0.0f;
  for (const ConeReturn& point : returns) {
    const float residual = (point.position - fit.axis).norm() - shape.RadiusAt(point.height);
    sum += residual * residual;
  }
  fit.residual = std::sqrt(sum / static_cast<float>(returns.size()));
  return fit;
}

}  // namespace hairpin
