#pragma once

#include <Eigen/SparseCore>

namespace hairpin {

/// The minimum of x^T H x / 2 + f^T x within lower <= x <= upper, by a primal-dual interior-point
/// method [Nocedal and Wright 2006, chapter 16.6]; its Newton step is one sparse factorisation, so
/// that a banded H costs time linear in its size. H is symmetric and positive definite. Bounds
/// closer together than 1e-6 count as one, in their middle. At most 60 steps, to a complementarity
/// of 1e-9 relative to the size of f. Throws std::invalid_argument for sizes that differ, bounds
/// that cross or values not finite, std::runtime_error where H is not positive definite.
Eigen::VectorXd SolveBoxQp(const Eigen::SparseMatrix<double>& H, const Eigen::VectorXd& f,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace hairpin
