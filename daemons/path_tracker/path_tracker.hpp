#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/car.hpp"
#include "common/geometry.hpp"
#include "common/pose_history.hpp"
#include "daemons/path_tracker/drive_gate.hpp"
#include "daemons/path_tracker/race_guide.hpp"
#include "daemons/path_tracker/reference_path.hpp"
#include "daemons/path_tracker/speed_profile.hpp"
#include "daemons/path_tracker/steering.hpp"
#include "daemons/path_tracker/wheel_forces.hpp"

namespace hairpin {

/// Acceleration from the difference to the speed wanted, and standing still.
struct SpeedControlParams {
  double gain = 0.0;              // acceleration per missing speed [1/s], > 0
  double max_acceleration = 0.0;  // [m/s2], > 0
  double max_braking = 0.0;       // [m/s2], >= the planned braking
  double delay = 0.0;             // of motors and brakes [s], >= 0
  double standstill_speed = 0.0;  // slower is standing [m/s], > 0
  double launch_speed =
      0.0;  // leave standstill only for a target above this [m/s], > standstill_speed
  double hold_brake = 0.0;  // while standing, 0 to 1
};

/// How fast a command may grow; letting go is immediate, except for steering.
struct CommandRates {
  double steering = 0.0;  // [rad/s], > 0
  double torque = 0.0;    // of one wheel [Nm/s], > 0
  double brake = 0.0;     // [1/s], > 0
};

struct PathTrackerParams {
  Car car;
  ReferencePathParams path;
  SpeedProfileParams speed;
  SteeringParams steering;
  WheelForcesParams forces;
  DriveGateParams gate;
  SpeedControlParams control;
  CommandRates rates;
  RaceGuideParams race;
  double race_max_acceleration = 0.0;  // on the race line [m/s2], >= control.max_acceleration
  double finish_distance = 0.0;  // the car stands so far after the finish at the latest [m], > 0
  double reaction_time =
      0.0;  // t of v <= sqrt(2 a (L - v t)), from the path's own time on [s], >= 0
  double steering_delay = 0.0;  // from command to wheel angle [s], >= 0
};

/// A path as it arrives: in the mapper's local frame, with the pose that the mapper had.
struct PathInput {
  int64_t utime = 0;
  Pose2 T_local_base;                   // at utime
  std::vector<Eigen::Vector2d> points;  // local [m], from the car outward
  size_t num_seen = 0;                  // so many points from the first on are supported by cones
  double seen_length = 0.0;             // from the car [m]
  std::vector<double> widths;           // of the track, by point [m]
};

/// What the actuators are to do; fields as in drive_command_t.
struct TrackerCommand {
  int64_t path_utime = 0;  // 0: none
  bool on_race_line = false;
  DriveAction action = DriveAction::kHold;
  double steering_angle = 0.0;
  std::array<double, 4> wheel_torque{};
  double brake = 0.0;
  double target_speed = 0.0;
  double target_acceleration = 0.0;
  double lateral_error = 0.0;
};

/// Steers the car along the middle path and chooses its speed. For each path: smooth curve and
/// speed profile; for each velocity: dead reckoning, place on the path now and after the actuators'
/// delay, command.
///
/// Where there is a race line and no doubt of it (RaceGuide), the car follows that one at the
/// speeds planned for it, within the friction circle of the commands; the middle path stays at
/// hand, and the car moves over to it at the first doubt.
///
/// Speed obeys v <= sqrt(2 a (L - v t)) over the seen length L [FAULTS 36]. The reaction time t
/// runs from the path's own time: while the path's age is below t, the place where the profile is
/// read stands still, so that waiting for the next path costs no braking; afterwards the car
/// follows the profile down to standstill before the end of what was seen.
class PathTracker {
 public:
  /// Throws std::invalid_argument for parameters out of their bounds.
  explicit PathTracker(const PathTrackerParams& params);

  /// Takes a path to follow. Returns why it was refused, empty if taken: not newer than the last
  /// one, older than `max_data_age` against the newest velocity, outside the pose history, or
  /// without length.
  std::string TakePath(const PathInput& path);
  /// Takes a race line. Returns why it was refused, empty if taken: not newer than the last one,
  /// outside the pose history, or without length.
  std::string TakeRaceLine(const RaceLineInput& line);
  /// Messages older than the last one are ignored; returns false for them.
  bool TakeAsState(const AsStateInput& as_state);
  bool TakePipelineStatus(const PipelineStatusInput& status);

  /// The command at `utime`, for the velocity of base then; `velocity` is empty where the estimator
  /// has none. No command where `utime` does not increase.
  std::optional<TrackerCommand> Answer(int64_t utime, const std::optional<Twist2>& velocity);

 private:
  /// The path in this class's own dead-reckoned frame, and where the car is on it.
  struct Followed {
    int64_t utime;
    ReferencePath path;
    SpeedProfile profile;
    double progress;  // arc length of base [m]
  };

  void CompareRaceLine(const PathInput& input, const Pose2& T_own_local);
  double SeenLength(const ReferencePath& path, const PathInput& input,
                    const Pose2& T_own_local) const;
  ReferencePath::Location LocateOnPath(const Pose2& T_own_base) const;
  /// On the path, the race line, or on what lies between them while the car moves over.
  ReferencePath::Location Locate(const Pose2& T_own_base) const;
  double Steer(const Pose2& T_own_base) const;
  SpeedProfile::Limit PathSpeed(int64_t utime) const;
  SpeedProfile::Limit RaceSpeed() const;
  SpeedProfile::Limit TargetSpeed(int64_t utime) const;
  /// Places the car on the path and fills in what follows from it; the speed wanted, empty without
  /// a path.
  std::optional<SpeedProfile::Limit> Follow(const DriveDecision& decision, int64_t utime,
                                            TrackerCommand& command);
  double Accelerate(const DriveDecision& decision,
                    const std::optional<SpeedProfile::Limit>& target) const;
  bool Stands(const DriveDecision& decision, double target_speed) const;
  Actuation Actuate(const TrackerCommand& command, bool stands, bool velocity_valid) const;
  void LimitRates(TrackerCommand& command, double dt) const;

  PathTrackerParams params_;
  SteeringLaw steering_;
  WheelForces forces_;
  PoseHistory history_;
  RaceGuide race_;
  std::optional<Followed> followed_;
  std::optional<AsStateInput> as_state_;
  std::optional<PipelineStatusInput> status_;
  std::optional<double> finish_deceleration_;  // once the mission is finished [m/s2]
  Twist2 twist_;                               // the last valid one
  int64_t last_utime_ = 0;
  TrackerCommand last_;
};

}  // namespace hairpin
