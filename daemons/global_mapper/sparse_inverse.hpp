#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace hairpin {

/// Those entries of the inverse of a sparse positive definite matrix that lie where its Cholesky
/// factor has entries: the diagonal, and wherever the matrix itself has any. Found from the factor
/// by Takahashi's recursion, at about the cost of the factor [Takahashi 1973; Kaess 2009,
/// "Covariance recovery from a square root information matrix"].
class SparseInverse {
 public:
  /// Of `H` only the lower triangle is read. Throws std::invalid_argument where it is not positive
  /// definite.
  explicit SparseInverse(const Eigen::SparseMatrix<double>& H);

  /// Zero where neither the factor nor the diagonal has an entry.
  double operator()(Eigen::Index row, Eigen::Index column) const;

 private:
  Eigen::VectorXi place_;           // of a variable in the order of elimination
  Eigen::SparseMatrix<double> Z_;   // strictly lower triangle, in that order
  Eigen::VectorXd diagonal_;        // the same
};

}  // namespace hairpin
