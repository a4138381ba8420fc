#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "daemons/global_mapper/factors.hpp"

namespace hairpin {

/// What poses that left the graph have to say about the landmarks that they saw and about the pose
/// that followed them: the quadratic cost 1/2 d^T H d - b^T d, with d the difference of (oldest
/// pose, landmarks) from a reference. Made by Schur complement of one pose after the other [Sibley
/// 2010, "Sliding window filter"], so that laps cost no more from one to the next.
class InformationPrior {
 public:
  /// Holds the oldest pose at `pose` with this variance of x, y [m^2] and yaw [rad^2].
  InformationPrior(const Eigen::Vector3d& pose, double variance);

  struct Sighting {
    size_t landmark;
    const LandmarkMeasurement* measurement;
    const double* position;  // of the landmark, map
    double weight;           // by the robust loss
  };
  /// Takes the oldest pose out; `next` becomes the oldest.
  void Marginalise(const double* oldest, const double* next, const OdometryMeasurement& odometry,
                   const std::vector<Sighting>& sightings);

  /// `into` takes over all that is known of `landmark`.
  void Merge(size_t landmark, size_t into);

  /// True if the prior says something of this landmark.
  bool Knows(size_t landmark) const { return SlotOf(landmark).has_value(); }
  std::vector<size_t> KnownAmong(const std::vector<size_t>& landmarks) const;

  /// A quadratic cost of some of the variables.
  struct Quadratic {
    Eigen::MatrixXd information;
    Eigen::VectorXd mean;  // absolute
  };
  /// Where every landmark is now, by number: (x, y).
  using Values = std::function<const double*(size_t)>;
  /// The cost of these landmarks, each of which it knows, while all else stands at its value. Empty
  /// where their information is singular.
  std::optional<Quadratic> Condition(const std::vector<size_t>& landmarks, const double* pose,
                                     const Values& values) const;

  /// The cost of the oldest pose and of some landmarks, while all others are wherever it is least:
  /// their Schur complement. They follow as mean - gain (x - cost.mean).
  struct Marginal {
    Quadratic cost;
    std::vector<size_t> others;
    Eigen::VectorXd mean;
    Eigen::MatrixXd gain;
    Eigen::LLT<Eigen::MatrixXd> information;  // of the others, the rest standing at its value
  };
  /// Of these landmarks, each of which it knows. Empty where an information is singular.
  std::optional<Marginal> Marginalised(const std::vector<size_t>& landmarks) const;

 private:
  std::optional<Eigen::Index> SlotOf(size_t landmark) const;
  Eigen::Index AddSlot(size_t landmark, const double* position);
  std::vector<Eigen::Index> RowsOf(const std::vector<size_t>& landmarks) const;
  Eigen::Index size() const { return b_.size(); }

  Eigen::MatrixXd
      H_;  // the first size() rows and columns; the rest is zero, kept for landmarks to come
  Eigen::VectorXd b_;
  Eigen::VectorXd reference_;
  std::vector<size_t> landmarks_;       // by slot
  std::vector<Eigen::Index> first_of_;  // row by landmark; -1: none
};

}  // namespace hairpin
