#include "daemons/velocity_estimator/unscented_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace hairpin {
namespace {

using Filter = UnscentedFilter<2>;
using Scalar = Eigen::Matrix<double, 1, 1>;

const Eigen::Matrix2d kTransition = (Eigen::Matrix2d() << 1.0, 0.1, 0.0, 1.0).finished();
const Eigen::Matrix2d kProcessNoise = (Eigen::Matrix2d() << 2e-3, 1e-3, 1e-3, 4e-2).finished();
const Eigen::RowVector2d kObservation(1.0, 0.3);
const Scalar kNoise(0.25);

TEST(UnscentedFilter, EqualsTheKalmanFilterOnALinearModel) {
  Eigen::Vector2d mean(1.0, -2.0);
  Eigen::Matrix2d covariance = (Eigen::Matrix2d() << 2.0, 0.7, 0.7, 1.0).finished();
  Filter filter(mean, covariance);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int step = 0; step < 100; ++step) {
    mean = kTransition * mean;
    covariance = kTransition * covariance * kTransition.transpose() + kProcessNoise;
    filter.Predict([](const Eigen::Vector2d& x) { return Eigen::Vector2d(kTransition * x); },
                   kProcessNoise);

    const Scalar z(normal(random));
    const Scalar s = kObservation * covariance * kObservation.transpose() + kNoise;
    const Eigen::Vector2d gain = covariance * kObservation.transpose() / s.value();
    const Scalar residual = z - kObservation * mean;
    const auto innovation = filter.Compare<1>(
        z, [](const Eigen::Vector2d& x) { return Scalar(kObservation * x); }, kNoise);
    EXPECT_NEAR(innovation.nis, residual.value() * residual.value() / s.value(), 1e-9);
    filter.Apply(innovation);
    mean += gain * residual;
    covariance -= gain * s * gain.transpose();

    ASSERT_TRUE(filter.mean().isApprox(mean, 1e-9));
    ASSERT_TRUE(filter.covariance().isApprox(covariance, 1e-9));
  }
}

TEST(UnscentedFilter, MeansAProductOfTwoStatesExactly) {
  // E[x y] = E[x] E[y] + cov(x, y), which a linearised filter gets wrong by the covariance.
  Filter filter(Eigen::Vector2d(2.0, 3.0), (Eigen::Matrix2d() << 1.0, 0.5, 0.5, 1.0).finished());
  const auto product = [](const Eigen::Vector2d& x) { return Scalar(x[0] * x[1]); };
  EXPECT_NEAR(filter.Compare<1>(Scalar(0.0), product, kNoise).residual.value(), -6.5, 1e-12);
}

TEST(UnscentedFilter, ComparingChangesNothing) {
  Filter filter(Eigen::Vector2d(2.0, 3.0), Eigen::Matrix2d::Identity());
  filter.Compare<1>(
      Scalar(9.0), [](const Eigen::Vector2d& x) { return Scalar(x[0]); }, kNoise);
  EXPECT_EQ(filter.mean(), Eigen::Vector2d(2.0, 3.0));
  EXPECT_EQ(filter.covariance(), Eigen::Matrix2d::Identity());
}

TEST(UnscentedFilter, DiesOnACovarianceThatIsNone) {
  Filter filter(Eigen::Vector2d::Zero(), -Eigen::Matrix2d::Identity());
  const auto stay = [](const Eigen::Vector2d& x) { return x; };
  EXPECT_THROW(filter.Predict(stay, kProcessNoise), std::logic_error);
}

}  // namespace
}  // namespace hairpin
