#include "daemons/global_mapper/factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

namespace hairpin {
namespace {

using Vector = Eigen::VectorXd;

/// Central differences of f at x.
Eigen::MatrixXd Differences(const std::function<Vector(const Vector&)>& f, const Vector& x) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd J(f(x).size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Vector forth = x;
    Vector back = x;
    forth[i] += kStep;
    back[i] -= kStep;
    J.col(i) = (f(forth) - f(back)) / (2.0 * kStep);
  }
  return J;
}

Eigen::Matrix3d CorrelatedCovariance() {
  Eigen::Matrix3d P;
  P << 0.04, 0.015, 0.002, 0.015, 0.09, -0.004, 0.002, -0.004, 0.001;
  return P;
}

TEST(SqrtInformation, WhitensAResidualOfACorrelatedCovariance) {
  const Eigen::Matrix3d P = CorrelatedCovariance();
  const Eigen::Matrix3d S = SqrtInformation(P);
  const Eigen::Vector3d e(0.1, -0.2, 0.03);
  EXPECT_NEAR((S * e).squaredNorm(), e.dot(P.inverse() * e), 1e-9);
  EXPECT_TRUE((S * P * S.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-9));
}

TEST(SqrtInformation, RefusesACovarianceThatIsNotPositiveDefinite) {
  Eigen::Matrix2d P;
  P << 1.0, 2.0, 2.0, 1.0;
  EXPECT_THROW(SqrtInformation(P), std::invalid_argument);
}

TEST(OdometryResidual, IsZeroWhereThePosesAreAsMeasured) {
  const Pose2 from{3.0, -2.0, 3.1};
  const Pose2 motion{1.0, 0.2, 0.3};
  const Pose2 to = from * motion;  // its yaw has wrapped
  const OdometryMeasurement measurement{motion, SqrtInformation(CorrelatedCovariance())};
  const double a[] = {from.x, from.y, from.yaw};
  const double b[] = {to.x, to.y, to.yaw};
  Eigen::Vector3d r;
  OdometryResidual(measurement, a, b, r.data(), nullptr, nullptr);
  EXPECT_LT(r.norm(), 1e-9);
}

TEST(OdometryResidual, HasTheJacobiansOfItsDifferences) {
  const OdometryMeasurement measurement{{1.0, 0.2, 0.3}, SqrtInformation(CorrelatedCovariance())};
  Vector x(6);
  x << 3.0, -2.0, 0.7, 3.8, -1.2, 1.1;
  const auto f = [&](const Vector& v) {
    Vector r(3);
    OdometryResidual(measurement, v.data(), v.data() + 3, r.data(), nullptr, nullptr);
    return r;
  };
  Eigen::Vector3d r;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_from;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_to;
  OdometryResidual(measurement, x.data(), x.data() + 3, r.data(), by_from.data(), by_to.data());
  const Eigen::MatrixXd J = Differences(f, x);
  EXPECT_TRUE(J.leftCols(3).isApprox(by_from, 1e-6));
  EXPECT_TRUE(J.rightCols(3).isApprox(by_to, 1e-6));
}

TEST(LandmarkResidual, HasTheJacobiansOfItsDifferences) {
  const LandmarkMeasurement measurement{
      {4.0, 1.0}, SqrtInformation(Eigen::Matrix2d(CorrelatedCovariance().topLeftCorner<2, 2>()))};
  Vector x(5);
  x << 3.0, -2.0, 0.7, 5.0, 2.5;
  const auto f = [&](const Vector& v) {
    Vector r(2);
    LandmarkResidual(measurement, v.data(), v.data() + 3, r.data(), nullptr, nullptr);
    return r;
  };
  Eigen::Vector2d r;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_pose;
  Eigen::Matrix<double, 2, 2, Eigen::RowMajor> by_landmark;
  LandmarkResidual(measurement, x.data(), x.data() + 3, r.data(), by_pose.data(),
                   by_landmark.data());
  const Eigen::MatrixXd J = Differences(f, x);
  EXPECT_TRUE(J.leftCols(3).isApprox(by_pose, 1e-6));
  EXPECT_TRUE(J.rightCols(2).isApprox(by_landmark, 1e-6));
}

TEST(CauchyWeight, IsTheSlopeOfTheLoss) {
  const double s = 7.0;
  const double c = 3.0;
  const auto loss = [c](double x) { return c * c * std::log1p(x / (c * c)); };
  EXPECT_NEAR(CauchyWeight(s, c), (loss(s + 1e-5) - loss(s - 1e-5)) / 2e-5, 1e-6);
  EXPECT_EQ(CauchyWeight(s, 0.0), 1.0);
}

}  // namespace
}  // namespace hairpin
