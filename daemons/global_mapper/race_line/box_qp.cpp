#include "daemons/global_mapper/race_line/box_qp.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kLeastWidth = 1e-6;
constexpr double kTolerance = 1e-9;
constexpr double kCentring = 0.1;
constexpr double kToBoundary = 0.995;  // share of the way to the nearest bound that a step takes

void Check(const Eigen::SparseMatrix<double>& H, const Eigen::VectorXd& f,
           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = f.size();
  if (n == 0 || H.rows() != n || H.cols() != n || lower.size() != n || upper.size() != n) {
    throw std::invalid_argument("SolveBoxQp: sizes differ");
  }
  if (!f.allFinite() || !lower.allFinite() || !upper.allFinite()) {
    throw std::invalid_argument("SolveBoxQp: a value is not finite");
  }
  if ((lower.array() > upper.array()).any()) {
    throw std::invalid_argument("SolveBoxQp: a lower bound is above the upper one");
  }
}

// The largest step up to 1 that keeps value + step * change > 0.
double LongestStep(const Eigen::ArrayXd& value, const Eigen::ArrayXd& change) {
  double step = 1.0;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (change[i] < 0.0) step = std::min(step, -kToBoundary * value[i] / change[i]);
  }
  return step;
}

}  // namespace

Eigen::VectorXd SolveBoxQp(const Eigen::SparseMatrix<double>& H, const Eigen::VectorXd& f,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  Check(H, f, lower, upper);
  const Eigen::ArrayXd middle = 0.5 * (lower + upper).array();
  const Eigen::ArrayXd half = (0.5 * (upper - lower)).array().max(0.5 * kLeastWidth);
  const double scale = std::max(f.cwiseAbs().maxCoeff(), 1e-12);
  const auto n = static_cast<double>(f.size());

  Eigen::VectorXd x = middle.matrix();
  Eigen::ArrayXd dual_low = Eigen::ArrayXd::Constant(f.size(), scale);  // of x >= lower
  Eigen::ArrayXd dual_high = dual_low;                                  // of x <= upper
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(H);
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::ArrayXd low = x.array() - (middle - half);
    const Eigen::ArrayXd high = (middle + half) - x.array();
    const double gap = ((low * dual_low).sum() + (high * dual_high).sum()) / (2.0 * n);
    const Eigen::VectorXd gradient = H * x + f;
    const double residual = (gradient.array() - dual_low + dual_high).abs().maxCoeff();
    if (gap < kTolerance * scale && residual < kTolerance * scale) break;
    const double target = kCentring * gap;
    Eigen::SparseMatrix<double> newton = H;
    newton.diagonal() += (dual_low / low + dual_high / high).matrix();
    solver.factorize(newton);
    if (solver.info() != Eigen::Success) {
      throw std::runtime_error("SolveBoxQp: H is not positive definite");
    }
    const Eigen::VectorXd dx = solver.solve(-gradient + (target / low - target / high).matrix());
    const Eigen::ArrayXd change_low = (target - dual_low * dx.array()) / low - dual_low;
    const Eigen::ArrayXd change_high = (target + dual_high * dx.array()) / high - dual_high;
    const double primal = std::min(LongestStep(low, dx.array()), LongestStep(high, -dx.array()));
    const double dual =
        std::min(LongestStep(dual_low, change_low), LongestStep(dual_high, change_high));
    const double step = std::min(primal, dual);
    x += step * dx;
    dual_low += step * change_low;
    dual_high += step * change_high;
  }
  return x;
}

}  // namespace hairpin
