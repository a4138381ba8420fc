#pragma once

#include <Eigen/Core>
#include <vector>

#include "daemons/global_mapper/factors.hpp"

namespace hairpin {

/// A problem for the solver; the values pointed to are refined in place. Poses are 3, landmarks 2
/// doubles.
struct LeastSquaresProblem {
  struct Odometry {
    double* from;
    double* to;
    const OdometryMeasurement* measurement;
  };
  struct Sighting {
    double* pose;
    double* landmark;
    const LandmarkMeasurement* measurement;
  };
  /// r = S (x - mean) of one landmark.
  struct Unary {
    double* landmark;
    Eigen::Vector2d mean;
    Eigen::Matrix2d sqrt_information;
  };
  std::vector<Odometry> odometry;
  std::vector<Sighting> sightings;
  std::vector<Unary> unaries;
  std::vector<double*> constant;  // values that stay
  /// r = S (x - mean) over these blocks together; none where empty.
  std::vector<double*> dense_blocks;
  std::vector<int> dense_sizes;
  Eigen::MatrixXd dense_sqrt_information;
  Eigen::VectorXd dense_mean;
};

struct SolverParams {
  int max_iterations = 0;   // > 0; the only bound on the time of a solve
  double loss_scale = 0.0;  // of Cauchy's loss on whitened sightings; 0: none
  double tolerance = 1e-6;  // relative decrease of the cost at which it is done
};

/// Levenberg-Marquardt by Ceres, one thread. Returns false, with the values undefined, where it
/// failed. [Agarwal, Mierle: Ceres Solver]
bool Solve(LeastSquaresProblem& problem, const SolverParams& params);

/// For a whole process, at its start: up to 64 MiB of freed memory stay with it. Each solve asks
/// for the same memory again, and a quarter of its time would go into pages that the kernel takes
/// back and clears.
void KeepFreedMemory();

}  // namespace hairpin
