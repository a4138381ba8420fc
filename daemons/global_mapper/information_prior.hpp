#pragma once

#include <Eigen/Core>
#include <cstddef>
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
  /// All landmarks that it knows, in the order of their slots.
  const std::vector<size_t>& landmarks() const { return landmarks_; }

  /// The cost as a function of some of its variables, the others standing at their values.
  struct Conditional {
    Eigen::MatrixXd information;
    Eigen::VectorXd mean;  // absolute
  };
  /// Variables: the oldest pose if `with_pose`, then `landmarks`, each of which it knows.
  /// `values(l)` is where landmark l is now. Empty where the information is singular.
  template <class Values>
  std::optional<Conditional> Condition(bool with_pose, const std::vector<size_t>& landmarks,
                                       const double* pose, const Values& values) const;

  /// Of (oldest pose, landmarks by slot).
  auto information() const { return H_.topLeftCorner(size(), size()); }

 private:
  std::optional<Eigen::Index> SlotOf(size_t landmark) const;
  Eigen::Index AddSlot(size_t landmark, const double* position);
  std::optional<Conditional> Condition(const std::vector<Eigen::Index>& kept,
                                       const Eigen::VectorXd& difference) const;
  Eigen::Index size() const { return b_.size(); }

  Eigen::MatrixXd H_;  // the first size() rows and columns; the rest is zero, kept for landmarks to come
  Eigen::VectorXd b_;
  Eigen::VectorXd reference_;
  std::vector<size_t> landmarks_;       // by slot
  std::vector<Eigen::Index> first_of_;  // row by landmark; -1: none
};

template <class Values>
std::optional<InformationPrior::Conditional> InformationPrior::Condition(
    bool with_pose, const std::vector<size_t>& landmarks, const double* pose,
    const Values& values) const {
  Eigen::VectorXd difference = -reference_;
  for (Eigen::Index i = 0; i < 3; ++i) difference[i] += pose[i];
  for (const size_t landmark : landmarks_) {
    const double* position = values(landmark);
    for (Eigen::Index i = 0; i < 2; ++i) difference[*SlotOf(landmark) + i] += position[i];
  }
  std::vector<Eigen::Index> kept;
  if (with_pose) kept = {0, 1, 2};
  for (const size_t landmark : landmarks) {
    const Eigen::Index first = *SlotOf(landmark);
    kept.push_back(first);
    kept.push_back(first + 1);
  }
  return Condition(kept, difference);
}

}  // namespace hairpin
