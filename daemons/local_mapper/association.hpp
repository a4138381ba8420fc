#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hairpin {

/// A normal distribution in the plane, in local [m].
struct Gaussian2 {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

/// D_B = 1/8 d^T S^-1 d + 1/2 ln(det S / sqrt(det S1 det S2)), S = (S1 + S2) / 2, d = m1 - m2; >=
/// 0, 0 for equals. Covariances must be positive definite. [Bhattacharyya 1943, as cited in paper
/// III-C]
double BhattacharyyaDistance(const Gaussian2& a, const Gaussian2& b);

struct AssociationParams {
  double gate_chi2 = 0.0;  // bound of the squared Mahalanobis distance of the innovation, > 0
  double gate_sigma =
      0.0;  // m, >= 0: disagreement that no covariance models (a cone is no point, clocks differ)
};

/// For each observation the index of its landmark, or none. One observation to one landmark.
///
/// A pair is in the gate where the innovation is consistent: d^T (P + R + gate_sigma^2 I)^-1 d <
/// gate_chi2, with the landmark's covariance P and the observation's R. Of the pairs in the gate
/// the one with the smallest D_B is taken first, then the smallest among what is left, and so on;
/// ties go to lower indices.
///
/// D_B compares the observation, N(z, R), with what the landmark predicts for an observation like
/// it, N(m, P + R). Compared with N(m, P) itself, the logarithm would punish a well-known cone for
/// a coarse observation: in the gate of both, a phantom as vague as the observation would take it
/// away from the cone.
std::vector<std::optional<size_t>> Associate(const std::vector<Gaussian2>& landmarks,
                                             const std::vector<Gaussian2>& observations,
                                             const AssociationParams& params);

}  // namespace hairpin
