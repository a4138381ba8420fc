#include <Eigen/LU>

#include "common/require.hpp"
#include "daemons/global_mapper/pose_landmark_graph.hpp"
#include "daemons/global_mapper/sparse_inverse.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

using Triplets = std::vector<Eigen::Triplet<double>>;

/// A block at (row, column) of the whole, row >= column where they differ.
template <class Block>
void Add(const Block& block, Eigen::Index row, Eigen::Index column, Triplets& triplets) {
  for (Eigen::Index i = 0; i < block.rows(); ++i) {
    for (Eigen::Index j = 0; j < block.cols(); ++j) {
      if (row + i >= column + j)
        triplets.emplace_back(static_cast<int>(row + i), static_cast<int>(column + j), block(i, j));
    }
  }
}

/// The entries of these rows and columns, each of which is there.
Eigen::MatrixXd DenseBlock(const SparseInverse& inverse, const std::vector<Eigen::Index>& rows) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd block(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j)
      block(i, j) = inverse(rows[static_cast<size_t>(i)], rows[static_cast<size_t>(j)]);
  }
  return block;
}

/// Of the landmarks that follow others: what is uncertain of them where those stand, and with
/// those, whose covariance is `followed`.
void AddOthers(const InformationPrior::Marginal& prior, const Eigen::MatrixXd& followed,
               std::vector<Eigen::Matrix2d>& covariances) {
  const Eigen::Index size = prior.gain.rows();
  const Eigen::MatrixXd root =
      prior.information.matrixL().solve(Eigen::MatrixXd::Identity(size, size));
  for (size_t k = 0; k < prior.others.size(); ++k) {
    const auto first = 2 * static_cast<Eigen::Index>(k);
    const auto column = root.middleCols<2>(first);
    const auto gain = prior.gain.middleRows<2>(first);
    covariances[prior.others[k]] = column.transpose() * column + gain * followed * gain.transpose();
  }
}

}  // namespace

/// Of all poses, three rows each, and of landmark l from row `first_of[l]` on, or not at all where
/// that is negative: what the poses say, and of the rows `prior_rows` together `prior`. The lower
/// triangle.
Eigen::SparseMatrix<double> PoseLandmarkGraph::Information(
    const std::vector<Eigen::Index>& first_of, const std::vector<Eigen::Index>& prior_rows,
    const Eigen::MatrixXd& prior) const {
  Triplets triplets;
  Eigen::Index size = 3 * static_cast<Eigen::Index>(poses_.size());
  for (const Eigen::Index first : first_of) size += first >= 0 ? 2 : 0;
  for (size_t i = 0; i < poses_.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const PoseNode& pose = poses_[i];
    if (i > 0) {
      Eigen::Vector3d r;
      Eigen::Matrix<double, 3, 3, Eigen::RowMajor> J0, J1;
      OdometryResidual(pose.odometry, poses_[i - 1].x.data(), pose.x.data(), r.data(), J0.data(),
                       J1.data());
      Add(Eigen::Matrix3d(J0.transpose() * J0), row - 3, row - 3, triplets);
      Add(Eigen::Matrix3d(J1.transpose() * J0), row, row - 3, triplets);
      Add(Eigen::Matrix3d(J1.transpose() * J1), row, row, triplets);
    }
    for (const Sighting& sighting : pose.sightings) {
      Eigen::Vector2d r;
      Eigen::Matrix<double, 2, 3, Eigen::RowMajor> Jp;
      Eigen::Matrix<double, 2, 2, Eigen::RowMajor> Jl;
      LandmarkResidual(sighting.measurement, pose.x.data(), landmarks_[sighting.landmark].x.data(),
                       r.data(), Jp.data(), Jl.data());
      const double weight = WeightOf(pose, sighting);
      const Eigen::Index l = first_of[sighting.landmark];
      Add(Eigen::Matrix3d(weight * Jp.transpose() * Jp), row, row, triplets);
      Add(Eigen::Matrix<double, 2, 3>(weight * Jl.transpose() * Jp), l, row, triplets);
      Add(Eigen::Matrix2d(weight * Jl.transpose() * Jl), l, l, triplets);
    }
  }
  for (Eigen::Index i = 0; i < prior.rows(); ++i) {
    for (Eigen::Index j = 0; j < prior.cols(); ++j) {
      const Eigen::Index row = prior_rows[static_cast<size_t>(i)];
      const Eigen::Index column = prior_rows[static_cast<size_t>(j)];
      if (row >= column)
        triplets.emplace_back(static_cast<int>(row), static_cast<int>(column), prior(i, j));
    }
  }
  Eigen::SparseMatrix<double> H(size, size);
  H.setFromTriplets(triplets.begin(), triplets.end());
  return H;
}

std::vector<Eigen::Matrix2d> PoseLandmarkGraph::LandmarkCovariances() const {
  const std::vector<size_t> seen = SeenFrom(first_pose_);
  const std::vector<size_t> known = prior_.KnownAmong(seen);
  const auto prior = prior_.Marginalised(known);
  require(prior.has_value(), "information is not positive definite");
  std::vector<Eigen::Index> first_of(landmarks_.size(), -1);
  auto next = 3 * static_cast<Eigen::Index>(poses_.size());
  for (const size_t l : seen) {
    first_of[l] = next;
    next += 2;
  }
  std::vector<Eigen::Index> prior_rows{0, 1, 2};
  for (const size_t l : known) {
    prior_rows.push_back(first_of[l]);
    prior_rows.push_back(first_of[l] + 1);
  }
  const SparseInverse inverse(Information(first_of, prior_rows, prior->cost.information));
  std::vector<Eigen::Matrix2d> covariances(landmarks_.size(), Eigen::Matrix2d::Zero());
  for (const size_t l : seen) {
    const Eigen::Index i = first_of[l];
    covariances[l] << inverse(i, i), inverse(i + 1, i), inverse(i + 1, i), inverse(i + 1, i + 1);
  }
  AddOthers(*prior, DenseBlock(inverse, prior_rows), covariances);
  for (size_t l = 0; l < landmarks_.size(); ++l) {
    if (!landmarks_[l].alive) covariances[l].setZero();
  }
  return covariances;
}

}  // namespace hairpin
