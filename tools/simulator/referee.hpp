#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/car.hpp"
#include "tools/simulator/timing_lines.hpp"
#include "tools/simulator/track.hpp"
#include "tools/simulator/track_area.hpp"
#include "tools/simulator/vehicle.hpp"

namespace hairpin {

struct RefereeParams {
  int laps = 1;
  double start_limit_s = 0.0;         // from the beginning until AS Driving
  double time_limit_per_lap_s = 0.0;  // from AS Driving on
  double stop_distance_m = 0.0;       // after the finish, in which the car has to stand
  double finish_limit_s = 0.0;        // after the finish, in which AS Finished has to come
  double no_movement_limit_s = 0.0;   // standing while driving
  double standstill_mps = 0.0;
  double braking_distance_m = 0.0;  // of a brake test; 0: it is none
};

/// How a race went.
struct RaceResult {
  bool finished =
      false;           // all laps, stopped in time and place, AS Finished; or a brake test passed
  std::string reason;  // in words, why it ended as it did; empty while it goes on
  std::vector<double> lap_times_s;
  int cones_hit = 0;   // each cone once
  int off_course = 0;  // times that all four wheels were outside
  double max_speed_mps = 0.0;
  double mean_speed_mps = 0.0;  // from the start line to the finish, or to the end
  double distance_m = 0.0;
};

/// What the referee is told of the car each tick.
struct RefereeInput {
  int64_t utime = 0;
  bool driving = false;   // AS Driving
  bool finished = false;  // AS Finished
  std::string emergency;  // why the circuit is open; empty if it is closed
  bool res_stop = false;  // the RES has opened it
};

/// Judges a drive by the rules of Formula Student Germany: laps from the first crossing of the
/// start line on, cones down or out (DOO), off course, stop after the finish, limits of time. The
/// timing point is base. A cone that is hit disappears from the world, as if knocked aside and
/// away.
class Referee {
 public:
  /// Throws std::invalid_argument for values that cannot be, and for a track without two
  /// boundaries.
  Referee(const RefereeParams& params, const Car& car, const Track& track);

  /// One tick; times must rise. Nothing changes once it is done().
  void Judge(const RefereeInput& input, const VehicleState& state);

  bool done() const { return done_; }
  const RaceResult& result() const { return result_; }
  int laps() const { return static_cast<int>(result_.lap_times_s.size()); }
  /// Cones that still stand, in the track's order: left, right, others.
  const std::vector<TrackCone>& standing_cones() const { return standing_cones_; }

 private:
  void CountLaps(const RefereeInput& input, const VehicleState& state);
  void OnLine(double time, double distance);
  void KnockDownCones(const Pose2& T_map_base);
  void CheckCourse(const Pose2& T_map_base);
  void Measure(const VehicleState& state, double time);
  void CheckEnd(const RefereeInput& input, const VehicleState& state, double time);
  void CheckDrive(const RefereeInput& input, const VehicleState& state, double time);
  void CheckEmergency(const RefereeInput& input, const VehicleState& state, bool moves);
  void CheckStop(const RefereeInput& input, const VehicleState& state, double time);
  void End(bool finished, const std::string& reason);
  bool IsHit(const TrackCone& cone, const Pose2& T_base_map) const;

  RefereeParams params_;
  Car car_;
  TrackArea area_;
  TimingLines lines_;
  std::vector<TrackCone> standing_cones_;
  RaceResult result_;
  bool done_ = false;

  std::optional<int64_t> first_utime_;
  std::optional<Eigen::Vector2d> last_position_;
  double last_time_ = 0.0;  // s since first_utime_, as all times below
  double last_distance_ = 0.0;
  std::optional<double> lap_start_;    // of the lap being driven
  std::optional<double> timed_start_;  // of the first lap
  double timed_start_distance_ = 0.0;
  std::optional<double> finish_;
  double finish_distance_ = 0.0;
  std::optional<double> driving_since_;
  std::optional<double> last_movement_;
  std::optional<double> emergency_distance_;  // driven when the circuit opened
  bool outside_ = false;
};

}  // namespace hairpin
