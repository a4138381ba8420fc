#include "daemons/global_mapper/sparse_inverse.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <stdexcept>

namespace hairpin {
namespace {

/// Each variable tied to a few others at random, and held.
Eigen::MatrixXd RandomInformation(int size, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> any(0, size - 1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd H = 0.1 * Eigen::MatrixXd::Identity(size, size);
  for (int i = 0; i < 3 * size; ++i) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row[any(random)] += normal(random);
    row[any(random)] += normal(random);
    H += row * row.transpose();
  }
  return H;
}

TEST(SparseInverse, IsTheDenseInverseWhereTheMatrixHasEntries) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const Eigen::MatrixXd H = RandomInformation(40, seed);
    const Eigen::MatrixXd expected = H.inverse();
    const SparseInverse inverse(H.sparseView());
    for (int i = 0; i < 40; ++i) {
      for (int j = 0; j < 40; ++j) {
        if (H(i, j) == 0.0 && i != j) continue;
        EXPECT_NEAR(inverse(i, j), expected(i, j), 1e-9 * expected.norm());
      }
    }
  }
}

TEST(SparseInverse, RefusesWhatIsNotPositiveDefinite) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(3, 3);
  H(1, 1) = -1.0;
  EXPECT_THROW(SparseInverse(H.sparseView()), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
