#include "daemons/global_mapper/least_squares.hpp"

#include <ceres/ceres.h>
#include <malloc.h>

#include <deque>
#include <memory>

namespace hairpin {
namespace {

class OdometryCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit OdometryCost(const OdometryMeasurement& measurement) : measurement_(&measurement) {}
  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    OdometryResidual(*measurement_, x[0], x[1], residual, jacobians ? jacobians[0] : nullptr,
                     jacobians ? jacobians[1] : nullptr);
    return true;
  }

 private:
  const OdometryMeasurement* measurement_;
};

/// The direction of a pose's yaw, found once for all sightings from it.
class KnownDirection {
 public:
  const Direction& Of(double yaw) {
    if (yaw != yaw_) {
      yaw_ = yaw;
      direction_ = Direction(yaw);
    }
    return direction_;
  }

 private:
  double yaw_ = 0.0;
  Direction direction_{0.0};
};

class SightingCost final : public ceres::SizedCostFunction<2, 3, 2> {
 public:
  SightingCost(const LandmarkMeasurement& measurement, KnownDirection& direction)
      : measurement_(&measurement), direction_(&direction) {}
  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    LandmarkResidual(*measurement_, x[0], direction_->Of(x[0][2]), x[1], residual,
                     jacobians ? jacobians[0] : nullptr, jacobians ? jacobians[1] : nullptr);
    return true;
  }

 private:
  const LandmarkMeasurement* measurement_;
  KnownDirection* direction_;
};

class UnaryCost final : public ceres::SizedCostFunction<2, 2> {
 public:
  UnaryCost(const Eigen::Vector2d& mean, const Eigen::Matrix2d& S) : mean_(mean), S_(S) {}
  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    Eigen::Map<Eigen::Vector2d>{residual} = S_ * (Eigen::Map<const Eigen::Vector2d>(x[0]) - mean_);
    if (jacobians != nullptr && jacobians[0] != nullptr)
      Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>{jacobians[0]} = S_;
    return true;
  }

 private:
  Eigen::Vector2d mean_;
  Eigen::Matrix2d S_;
};

class DenseCost final : public ceres::CostFunction {
 public:
  explicit DenseCost(const LeastSquaresProblem& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.dense_mean.size()));
    for (const int size : problem.dense_sizes) mutable_parameter_block_sizes()->push_back(size);
  }
  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const Eigen::MatrixXd& S = problem_.dense_sqrt_information;
    Eigen::VectorXd difference = -problem_.dense_mean;
    Eigen::Index first = 0;
    for (size_t i = 0; i < problem_.dense_sizes.size(); ++i) {
      const int size = problem_.dense_sizes[i];
      difference.segment(first, size) += Eigen::Map<const Eigen::VectorXd>(x[i], size);
      if (jacobians != nullptr && jacobians[i] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            jacobians[i], S.rows(), size) = S.middleCols(first, size);
      }
      first += size;
    }
    Eigen::Map<Eigen::VectorXd>(residual, S.rows()).noalias() =
        S.triangularView<Eigen::Upper>() * difference;
    return true;
  }

 private:
  const LeastSquaresProblem& problem_;
};

ceres::Problem::Options ProblemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

ceres::Solver::Options SolverOptions(const SolverParams& params) {
  ceres::Solver::Options options;
  options.max_num_iterations = params.max_iterations;
  options.function_tolerance = params.tolerance;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-9;
  options.initial_trust_region_radius = 1e8;  // begins as Gauss-Newton
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Graphs of this size are sparse throughout: simplicial factors take half the time of supernodal
  // ones.
  options.sparse_linear_algebra_library_type = ceres::CX_SPARSE;
  options.jacobi_scaling = false;  // a Cholesky factor gains nothing by it
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  // No bound on the time: the same input shall give the same bytes on any machine.
  options.max_solver_time_in_seconds = 1e9;
  return options;
}

}  // namespace

void KeepFreedMemory() {
  constexpr int kMebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMebibyte);
  mallopt(M_TRIM_THRESHOLD, 64 * kMebibyte);
}

bool Solve(LeastSquaresProblem& problem, const SolverParams& params) {
  std::deque<OdometryCost> odometry;  // deques: Ceres keeps their addresses
  std::deque<SightingCost> sightings;
  std::deque<KnownDirection> directions;  // by run of sightings from one pose
  std::deque<UnaryCost> unaries;
  std::unique_ptr<DenseCost> dense;
  std::unique_ptr<ceres::LossFunction> loss;
  if (params.loss_scale > 0.0) loss = std::make_unique<ceres::CauchyLoss>(params.loss_scale);

  ceres::Problem graph(ProblemOptions());
  for (const auto& term : problem.odometry) {
    odometry.emplace_back(*term.measurement);
    graph.AddResidualBlock(&odometry.back(), nullptr, term.from, term.to);
  }
  const double* pose = nullptr;
  for (const auto& term : problem.sightings) {
    if (term.pose != pose) directions.emplace_back();
    pose = term.pose;
    sightings.emplace_back(*term.measurement, directions.back());
    graph.AddResidualBlock(&sightings.back(), loss.get(), term.pose, term.landmark);
  }
  for (const auto& term : problem.unaries) {
    unaries.emplace_back(term.mean, term.sqrt_information);
    graph.AddResidualBlock(&unaries.back(), nullptr, term.landmark);
  }
  if (!problem.dense_blocks.empty()) {
    dense = std::make_unique<DenseCost>(problem);
    graph.AddResidualBlock(dense.get(), nullptr, problem.dense_blocks);
  }
  for (double* block : problem.constant) {
    if (graph.HasParameterBlock(block)) graph.SetParameterBlockConstant(block);
  }
  if (graph.NumResidualBlocks() == 0) return true;
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(params), &graph, &summary);
  return summary.IsSolutionUsable();
}

}  // namespace hairpin
