#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config.hpp"
#include "hairpin/gnss_t.hpp"
#include "hairpin/truth_t.hpp"
#include "tools/simulator/track.hpp"

namespace hairpin {

struct ReceiverTruthParams {
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();  // of the main antenna, base [m]
  double max_position_sigma = 0.0;                    // of east and of north [m]
  double max_heading_sigma = 0.0;                     // rad
};

/// Reads `truth.yaml` and the antenna's mount of `car.yaml`. Throws ConfigError.
ReceiverTruthParams LoadReceiverTruthParams(const Config& config);

/// A time without truth between two solutions, longer than readers interpolate over.
struct TruthGap {
  int64_t from_utime = 0;
  int64_t to_utime = 0;
};

struct ReceiverTruth {
  std::vector<truth_t> truth;  // one for each solution that counts, at its time
  /// Solutions that do not, by reason; every reason is there.
  std::map<std::string, int64_t> left_out;
  std::vector<TruthGap> gaps;  // between the first and the last
};

/// The true motion of base by the fixed RTK solutions of a dual-antenna receiver on the car.
/// `fixes`: in the track's map (x east, y north), with the heading of base, in order of time.
///
/// Left out are, besides what is not fixed: "stale" ones, not newer than the last or a repetition
/// of it; those without a heading; "uncertain" ones.
///
/// Pose: base = antenna - R(yaw) lever. Velocity: the receiver's, less what turning gives the
/// antenna; yaw rate by the headings of the neighbouring solutions, so a solution without a
/// neighbour within kMaxTruthGap is left out ("lone"). Distance: the way from one to the next along
/// the car, so that noise does not add up at standstill; through a gap the straight line. Laps by
/// the track's lines. What a receiver cannot tell is zero: acceleration, steering angle, cones hit,
/// off course. Planar: the antenna's height times the roll is left in.
ReceiverTruth TruthOfReceiver(const std::vector<gnss_t>& fixes, const Track& track,
                              const ReceiverTruthParams& params);

}  // namespace hairpin
