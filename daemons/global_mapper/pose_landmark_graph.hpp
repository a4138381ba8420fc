#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "common/geometry.hpp"
#include "daemons/global_mapper/factors.hpp"
#include "daemons/global_mapper/information_prior.hpp"
#include "daemons/global_mapper/least_squares.hpp"

namespace hairpin {

struct GraphParams {
  SolverParams window;      // solves after each pose
  SolverParams full;        // solves of all
  size_t window_poses = 0;  // newest poses that a window solve moves, > 1

  /// Throws std::invalid_argument naming parameter, relation and bound.
  void Validate() const;
};

/// Poses of base and landmarks in map, tied by odometry and sightings: pose-landmark GraphSLAM
/// [Thrun 2006; paper III-C]. The first pose is held where it is put. Poses are numbered from 0 on,
/// for good; the oldest can be marginalised into a prior on the landmarks, which bounds the graph.
///
/// SolveWindow() moves the newest poses and what they see, while older poses stand: what these say
/// of a landmark is kept as one Gaussian for each (`frozen`), so that its cost does not grow.
/// SolveAll() moves everything. Both descend the same cost.
class PoseLandmarkGraph {
 public:
  explicit PoseLandmarkGraph(const GraphParams& params, const Pose2& first_pose = {});

  /// Adds the next pose by the motion from the newest one, and returns its number.
  size_t AddPose(const OdometryMeasurement& odometry);
  /// Returns its number, which stays.
  size_t AddLandmark(const Eigen::Vector2d& position);
  /// From the newest pose. Throws std::invalid_argument for an unknown landmark.
  void AddSighting(size_t landmark, const LandmarkMeasurement& measurement);
  /// The two are the same: all sightings of `landmark` become sightings of `into`.
  void MergeLandmark(size_t landmark, size_t into);
  /// No sighting of the landmark counts any more.
  void RemoveLandmark(size_t landmark);

  /// Each returns false, and leaves everything as it was, where the solver fails.
  bool SolveWindow();
  bool SolveAll();
  /// The same without a robust loss: for sightings that are known to be right however far off they
  /// look, where a loop was found.
  bool SolveAllTrustingSightings();
  /// Takes the oldest pose out, at least two must be there.
  void MarginaliseOldest();

  size_t num_poses() const { return poses_.size(); }
  size_t first_pose() const { return first_pose_; }
  size_t end_pose() const { return first_pose_ + poses_.size(); }
  size_t num_landmarks() const { return landmarks_.size(); }
  bool IsLandmark(size_t landmark) const { return landmarks_.at(landmark).alive; }
  Pose2 pose(size_t number) const;
  Pose2 newest_pose() const { return pose(end_pose() - 1); }
  Eigen::Vector2d landmark(size_t number) const;
  /// True if one pose in the graph sees both, or poses that have left it may have.
  bool MayHaveBeenSeenTogether(size_t a, size_t b) const;

  /// Squared whitened residual of a measurement from the newest pose.
  double SquaredResidual(size_t landmark, const LandmarkMeasurement& measurement) const;
  /// Root mean square distance [m] between where poses from `from` on saw the landmark and where it
  /// is; empty where none did.
  std::optional<double> SightingRms(size_t landmark, size_t from) const;
  /// Half the sum of squared whitened residuals of all odometry and sightings in the graph, without
  /// any loss function; the prior of marginalised poses is not in it.
  double Cost() const;
  /// Covariances [m^2] of all landmarks given everything, by number; zero for those that are gone.
  /// Costs about what two iterations of SolveAll() do. Throws std::invalid_argument where the
  /// information is singular.
  std::vector<Eigen::Matrix2d> LandmarkCovariances() const;

 private:
  struct Sighting {
    size_t landmark;
    LandmarkMeasurement measurement;
    double frozen_weight = 1.0;  // with which it stands in the landmark's frozen part
  };
  struct PoseNode {
    std::array<double, 3> x;
    OdometryMeasurement odometry;  // from the pose before
    std::vector<Sighting> sightings;
  };
  struct LandmarkNode {
    std::array<double, 2> x;
    size_t first_pose = 0;  // that could see it
    bool alive = true;
    Eigen::Matrix2d frozen_information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d frozen_vector = Eigen::Vector2d::Zero();  // information times mean
  };
  struct Values {
    std::vector<std::array<double, 3>> poses;
    std::vector<std::array<double, 2>> landmarks;
  };

  Values Save() const;
  void Restore(const Values& values);
  double WeightOf(const PoseNode& pose, const Sighting& sighting) const;
  void Freeze(PoseNode& pose);
  void Thaw(const PoseNode& pose);
  void AddFrozen(const PoseNode& pose, const Sighting& sighting, double weight);
  void FreezeUpTo(size_t number);
  void RefreezeAll();
  void AddTerms(size_t from, LeastSquaresProblem& problem);
  std::vector<size_t> SeenFrom(size_t from) const;
  void AddPrior(const InformationPrior::Quadratic& cost, bool with_pose,
                const std::vector<size_t>& landmarks, LeastSquaresProblem& problem);
  void MoveUnseen(const InformationPrior::Marginal& prior, const std::vector<size_t>& seen);
  bool SolveAll(const SolverParams& params);
  bool Run(LeastSquaresProblem& problem, const SolverParams& params);
  Eigen::SparseMatrix<double> Information(const std::vector<Eigen::Index>& first_of,
                                          const std::vector<Eigen::Index>& prior_rows,
                                          const Eigen::MatrixXd& prior) const;

  GraphParams params_;
  size_t first_pose_ = 0;
  size_t frozen_end_ = 0;  // poses before this one stand in the landmarks' frozen parts
  std::deque<PoseNode> poses_;
  std::deque<LandmarkNode> landmarks_;
  InformationPrior prior_;
};

}  // namespace hairpin
