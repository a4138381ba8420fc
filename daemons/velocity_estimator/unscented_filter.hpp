#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <stdexcept>

namespace hairpin {

/// What a measurement says against the filter's expectation of it.
template <int N, int M>
struct Innovation {
  Eigen::Matrix<double, M, 1> residual;    // measured - expected
  Eigen::Matrix<double, M, M> covariance;  // S, of the residual
  Eigen::Matrix<double, N, M> cross;       // covariance of state and expected measurement
  double nis;  // y^T S^-1 y: chi-square with M degrees of freedom if all is well
};

/// Unscented Kalman filter with additive noise. Source: [Julier 1997], with kappa = 0: 2 N sigma
/// points at x +- sqrt(N) * (columns of the Cholesky factor of P), all of weight 1 / 2N. No weight
/// is negative, so P stays positive definite whatever the models do.
template <int N>
class UnscentedFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  UnscentedFilter(const Vector& mean, const Matrix& covariance) { Reset(mean, covariance); }

  void Reset(const Vector& mean, const Matrix& covariance) {
    mean_ = mean;
    covariance_ = covariance;
    points_are_current_ = false;
  }

  const Vector& mean() const { return mean_; }
  const Matrix& covariance() const { return covariance_; }

  /// x = f(x) + noise of covariance Q.
  template <class Process>
  void Predict(const Process& f, const Matrix& process_noise) {
    Points moved;
    const Points& points = SigmaPoints();
    for (int i = 0; i < kPoints; ++i) moved.col(i) = f(Vector(points.col(i)));
    mean_ = moved.rowwise().mean();
    moved.colwise() -= mean_;
    covariance_.noalias() = moved * moved.transpose() * kWeight;
    covariance_ += process_noise;
    points_are_current_ = false;
  }

  /// Trusts the state less: P += extra.
  void Inflate(const Matrix& extra) {
    covariance_ += extra;
    points_are_current_ = false;
  }

  /// Compares z with h(x) + noise of covariance R; changes nothing.
  template <int M, class Measurement>
  Innovation<N, M> Compare(const Eigen::Matrix<double, M, 1>& z, const Measurement& h,
                           const Eigen::Matrix<double, M, M>& noise) {
    Eigen::Matrix<double, M, kPoints> expected;
    const Points& points = SigmaPoints();
    for (int i = 0; i < kPoints; ++i) expected.col(i) = h(Vector(points.col(i)));
    const Eigen::Matrix<double, M, 1> mean = expected.rowwise().mean();
    expected.colwise() -= mean;
    Innovation<N, M> innovation;
    innovation.residual = z - mean;
    innovation.covariance.noalias() = expected * expected.transpose() * kWeight;
    innovation.covariance += noise;
    innovation.cross.noalias() = (points.colwise() - mean_) * expected.transpose() * kWeight;
    innovation.nis =
        innovation.residual.dot(innovation.covariance.llt().solve(innovation.residual));
    return innovation;
  }

  /// x += K y, P -= K S K^T, with K = P_xz S^-1. The innovation must be that of the present state.
  template <int M>
  void Apply(const Innovation<N, M>& innovation) {
    const Eigen::LLT<Eigen::Matrix<double, M, M>> factor(innovation.covariance);
    mean_ += innovation.cross * factor.solve(innovation.residual);
    const Eigen::Matrix<double, M, N> root = factor.matrixL().solve(innovation.cross.transpose());
    covariance_.noalias() -= root.transpose() * root;
    points_are_current_ = false;
  }

 private:
  static constexpr int kPoints = 2 * N;
  static constexpr double kWeight = 1.0 / kPoints;
  using Points = Eigen::Matrix<double, N, kPoints>;

  const Points& SigmaPoints() {
    if (points_are_current_) return points_;
    const Eigen::LLT<Matrix> factor(covariance_);
    if (factor.info() != Eigen::Success)
      throw std::logic_error("UnscentedFilter: covariance is not positive definite");
    const Matrix spread = std::sqrt(static_cast<double>(N)) * Matrix(factor.matrixL());
    points_.template leftCols<N>() = spread.colwise() + mean_;
    points_.template rightCols<N>() = (-spread).colwise() + mean_;
    points_are_current_ = true;
    return points_;
  }

  Vector mean_;
  Matrix covariance_;
  Points points_;
  bool points_are_current_ = false;
};

}  // namespace hairpin
