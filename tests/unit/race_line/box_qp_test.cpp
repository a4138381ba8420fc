#include "daemons/global_mapper/race_line/box_qp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

namespace hairpin {
namespace {

// Coordinate descent: slow, but its every fixed point is the minimum of a convex problem in a box.
Eigen::VectorXd Naive(const Eigen::MatrixXd& H, const Eigen::VectorXd& f,
                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  Eigen::VectorXd x = 0.5 * (lower + upper);
  for (int sweep = 0; sweep < 20000; ++sweep) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double rest = H.row(i).dot(x) - H(i, i) * x[i] + f[i];
      x[i] = std::clamp(-rest / H(i, i), lower[i], upper[i]);
    }
  }
  return x;
}

struct Problem {
  Eigen::MatrixXd H;
  Eigen::VectorXd f;
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

Problem RandomProblem(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Index n = 12;
  const auto draw = [&] { return normal(random); };
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, draw);
  Problem problem;
  problem.H = root.transpose() * root + 0.3 * Eigen::MatrixXd::Identity(n, n);
  problem.f = 3.0 * Eigen::VectorXd::NullaryExpr(n, draw);
  problem.lower = -Eigen::VectorXd::NullaryExpr(n, draw).cwiseAbs();
  problem.upper = Eigen::VectorXd::NullaryExpr(n, draw).cwiseAbs();
  return problem;
}

TEST(SolveBoxQp, AgreesWithCoordinateDescentOnRandomProblems) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Problem p = RandomProblem(seed);
    const Eigen::VectorXd x = SolveBoxQp(p.H.sparseView(), p.f, p.lower, p.upper);
    EXPECT_LT((x - Naive(p.H, p.f, p.lower, p.upper)).cwiseAbs().maxCoeff(), 1e-5) << seed;
  }
}

TEST(SolveBoxQp, FindsTheFreeMinimumWhereNoBoundIsInTheWay) {
  Problem p = RandomProblem(3);
  p.lower.setConstant(-1e3);
  p.upper.setConstant(1e3);
  const Eigen::VectorXd x = SolveBoxQp(p.H.sparseView(), p.f, p.lower, p.upper);
  EXPECT_LT((x - p.H.llt().solve(-p.f)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(SolveBoxQp, KeepsToBoundsThatAreOne) {
  Problem p = RandomProblem(4);
  p.upper = p.lower;
  const Eigen::VectorXd x = SolveBoxQp(p.H.sparseView(), p.f, p.lower, p.upper);
  EXPECT_LT((x - p.lower).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(SolveBoxQp, RefusesWhatIsNoProblem) {
  const Problem p = RandomProblem(5);
  const Eigen::SparseMatrix<double> H = p.H.sparseView();
  EXPECT_THROW(SolveBoxQp(H, p.f, p.upper, p.lower), std::invalid_argument);
  EXPECT_THROW(SolveBoxQp(H, p.f.head(3), p.lower, p.upper), std::invalid_argument);
  EXPECT_THROW(SolveBoxQp(H, p.f * std::nan(""), p.lower, p.upper), std::invalid_argument);
  const Eigen::SparseMatrix<double> negative = -100.0 * H;
  EXPECT_THROW(SolveBoxQp(negative, p.f, p.lower * 1e3, p.upper * 1e3), std::runtime_error);
}

}  // namespace
}  // namespace hairpin
