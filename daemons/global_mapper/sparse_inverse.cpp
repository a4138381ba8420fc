#include "daemons/global_mapper/sparse_inverse.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include "common/require.hpp"

namespace hairpin {
namespace {
constexpr Require require("global_mapper");
}  // namespace

SparseInverse::SparseInverse(const Eigen::SparseMatrix<double>& H) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor(H);
  require(factor.info() == Eigen::Success && (factor.vectorD().array() > 0.0).all(),
          "information is not positive definite");
  place_ = factor.permutationP().indices();
  const Eigen::SparseMatrix<double>& L = factor.matrixL().nestedExpression();
  Z_ = L;
  diagonal_ = factor.vectorD().cwiseInverse();

  // With H = L D L^T, Z = H^-1 and S the rows of column j of L below the diagonal:
  // Z_ij = - sum over k in S of Z_ik L_kj, and Z_jj = 1 / D_j - sum over k in S of L_kj Z_kj.
  // All Z_ik are among the entries found, of later columns.
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  Eigen::VectorXd column = Eigen::VectorXd::Zero(H.rows());  // L_kj by k, zero outside S
  Eigen::VectorXd sum(H.rows());                             // by i, any value outside S
  for (Eigen::Index j = H.rows(); j-- > 0;) {
    for (Entry k(L, j); k; ++k) {
      if (k.row() == j) continue;
      column[k.row()] = k.value();
      sum[k.row()] = 0.0;
    }
    for (Entry k(L, j); k; ++k) {
      if (k.row() == j) continue;
      double of_k = diagonal_[k.row()] * k.value();
      for (Entry i(Z_, k.row()); i; ++i) {
        if (i.row() == k.row()) continue;
        sum[i.row()] += i.value() * k.value();
        of_k += i.value() * column[i.row()];
      }
      sum[k.row()] += of_k;
    }
    for (Entry i(Z_, j); i; ++i) {
      if (i.row() == j) continue;
      i.valueRef() = -sum[i.row()];
      diagonal_[j] -= column[i.row()] * i.value();
      column[i.row()] = 0.0;
    }
  }
}

double SparseInverse::operator()(Eigen::Index row, Eigen::Index column) const {
  const int a = place_[row];
  const int b = place_[column];
  return a == b ? diagonal_[a] : Z_.coeff(std::max(a, b), std::min(a, b));
}

}  // namespace hairpin
