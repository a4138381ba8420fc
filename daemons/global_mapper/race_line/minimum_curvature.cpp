#include "daemons/global_mapper/race_line/minimum_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/require.hpp"
#include "daemons/global_mapper/race_line/box_qp.hpp"

namespace hairpin {
namespace {

constexpr double kInertia =
    1e-6;                        // 1/m^4 for each squared metre moved: H is definite on a straight
constexpr int kSweptWindow = 4;  // points to each side whose curvature decides the width swept

void Check(const MinimumCurvatureParams& params) {
  constexpr Require require("MinimumCurvatureLine");
  require(params.max_iterations >= 1, "max_iterations must be >= 1");
  require(params.max_step > 0.0, "max_step_m must be > 0");
  require(params.tolerance > 0.0, "tolerance_m must be > 0");
}

// The car's body reaches over more than one point.
double MeanCurvature(const ClosedCurve& line, size_t i) {
  double sum = 0.0;
  for (int k = -kSweptWindow; k <= kSweptWindow; ++k) {
    sum +=
        line.curvature()[(i + line.size() + static_cast<size_t>(k + kSweptWindow) - kSweptWindow) %
                         line.size()];
  }
  return sum / (2 * kSweptWindow + 1);
}

// A of r = k + A a: second difference and k^2.
Eigen::SparseMatrix<double> CurvatureChange(const ClosedCurve& line) {
  const auto n = static_cast<Eigen::Index>(line.size());
  const double per_square = 1.0 / (line.spacing() * line.spacing());
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double k = line.curvature()[static_cast<size_t>(i)];
    entries.emplace_back(i, (i + n - 1) % n, per_square);
    entries.emplace_back(i, i, k * k - 2.0 * per_square);
    entries.emplace_back(i, (i + 1) % n, per_square);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Eigen::VectorXd Moves(const Corridor& corridor, const ClosedCurve& line, double max_step) {
  const auto n = static_cast<Eigen::Index>(line.size());
  Eigen::VectorXd lower(n);
  Eigen::VectorXd upper(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<size_t>(i);
    const Corridor::Room room =
        corridor.RoomAt(line.points()[at], line.normal(at), MeanCurvature(line, at));
    lower[i] = std::clamp(room.right, -max_step, max_step);
    upper[i] = std::clamp(room.left, -max_step, max_step);
  }
  const Eigen::Map<const Eigen::ArrayXd> k(line.curvature().data(), n);
  const Eigen::SparseMatrix<double> A = CurvatureChange(line);
  Eigen::SparseMatrix<double> H = 2.0 * Eigen::SparseMatrix<double>(A.transpose() * A);
  H.diagonal().array() += kInertia;
  const Eigen::VectorXd f = 2.0 * (A.transpose() * k.matrix()) - k.cube().matrix();
  return SolveBoxQp(H, f, lower, upper);
}

}  // namespace

ClosedCurve MinimumCurvatureLine(const Corridor& corridor, const MinimumCurvatureParams& params) {
  Check(params);
  const double spacing = corridor.centre().spacing();
  ClosedCurve line = corridor.centre();
  for (int iteration = 0; iteration < params.max_iterations; ++iteration) {
    const Eigen::VectorXd moves = Moves(corridor, line, params.max_step);
    Points moved;
    for (size_t i = 0; i < line.size(); ++i)
      moved.push_back(line.points()[i] + moves[static_cast<Eigen::Index>(i)] * line.normal(i));
    line = ClosedCurve(moved, spacing);
    if (moves.cwiseAbs().maxCoeff() < params.tolerance) break;
  }
  return line;
}

}  // namespace hairpin
