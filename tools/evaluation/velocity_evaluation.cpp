#include "tools/evaluation/velocity_evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/clock.hpp"
#include "daemons/velocity_estimator/motion_model.hpp"
#include "tools/report/map_comparison.hpp"
#include "tools/report/statistics.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

/// One estimator that hears one recording.
class Listener {
 public:
  explicit Listener(const VelocityEstimatorParams& params) : estimator_(params) {}

  void Hear(const ImuReading& reading) {
    if (estimator_.Add(reading) == Intake::kTaken) Advance(reading.utime);
  }
  template <class Reading>
  void Hear(const Reading& reading) {
    if (estimator_.Add(reading) == Intake::kTaken && estimator_.IsImuSilentAt(reading.utime))
      Advance(reading.utime);
  }
  DeadReckoning TakeRun() { return std::move(run_); }

 private:
  void Advance(int64_t utime) {
    if (estimator_.utime() && utime <= *estimator_.utime()) return;
    DeadReckoned next{estimator_.Advance(utime), {}};
    if (!run_.empty()) {
      const DeadReckoned& last = run_.back();
      const Twist2& a = last.estimate.velocity;
      const Twist2& b = next.estimate.velocity;
      const Twist2 mean{0.5 * (a.vx + b.vx), 0.5 * (a.vy + b.vy), 0.5 * (a.yaw_rate + b.yaw_rate)};
      next.T_local_base =
          last.T_local_base * Integrate(mean, SecondsBetween(last.estimate.utime, utime));
    }
    run_.push_back(std::move(next));
  }

  VelocityEstimator estimator_;
  DeadReckoning run_;
};

/// The two neighbours of a time, and the share of the way from one to the other.
struct Between {
  const DeadReckoned* before = nullptr;
  const DeadReckoned* after = nullptr;
  double share = 0.0;
};

std::optional<Between> At(const DeadReckoning& run, int64_t utime) {
  const auto after = std::lower_bound(
      run.begin(), run.end(), utime,
      [](const DeadReckoned& step, int64_t time) { return step.estimate.utime < time; });
  if (after == run.begin() || after == run.end()) return std::nullopt;
  const auto before = after - 1;
  const double share = SecondsBetween(before->estimate.utime, utime) /
                       SecondsBetween(before->estimate.utime, after->estimate.utime);
  return Between{&*before, &*after, share};
}

Eigen::Vector2d VelocityOf(const VelocityEstimate& estimate) {
  return {estimate.velocity.vx, estimate.velocity.vy};
}

std::optional<Eigen::Vector3d> VelocityAt(const DeadReckoning& run, int64_t utime) {
  const std::optional<Between> at = At(run, utime);
  if (!at) return std::nullopt;
  const Twist2& a = at->before->estimate.velocity;
  const Twist2& b = at->after->estimate.velocity;
  return Eigen::Vector3d(std::lerp(a.vx, b.vx, at->share), std::lerp(a.vy, b.vy, at->share),
                         std::lerp(a.yaw_rate, b.yaw_rate, at->share));
}

FaultOutcome CompareRuns(const DeadReckoning& sound, const DeadReckoning& faulty, int64_t from) {
  FaultOutcome outcome;
  int64_t changed_since = 0;
  bool is_changed = false;
  for (const DeadReckoned& step : faulty) {
    const int64_t utime = step.estimate.utime;
    const std::optional<Eigen::Vector3d> expected = VelocityAt(sound, utime);
    if (utime < from || !expected) continue;
    const double change = (VelocityOf(step.estimate) - expected->head<2>()).norm();
    outcome.max_mps = std::max(outcome.max_mps, change);
    outcome.is_always_valid = outcome.is_always_valid && step.estimate.valid;
    const bool was_changed = std::exchange(is_changed, change > FaultOutcome::kChanged);
    if (!is_changed) continue;
    if (!was_changed) changed_since = utime;
    outcome.longest_s = std::max(outcome.longest_s, SecondsBetween(changed_since, utime));
  }
  return outcome;
}

std::vector<FaultOutcome> TryFaults(const VelocityReport& report,
                                    const VelocityEstimatorParams& params) {
  const int64_t middle = report.drive.from + (report.drive.to - report.drive.from) / 2;
  std::vector<FaultOutcome> outcomes;
  for (const FaultySensor sensor :
       {FaultySensor::kImu, FaultySensor::kGyro, FaultySensor::kAccelerometer,
        FaultySensor::kOptical, FaultySensor::kWheels, FaultySensor::kOneWheel}) {
    for (const FaultKind kind :
         {FaultKind::kRemoved, FaultKind::kFrozen, FaultKind::kScaled, FaultKind::kSpiking}) {
      const SensorRecording faulty = WithFault(report.recording, sensor, kind, middle);
      FaultOutcome outcome = CompareRuns(report.run, RunEstimator(faulty, params), middle);
      outcome.sensor = sensor;
      outcome.kind = kind;
      outcomes.push_back(outcome);
    }
  }
  return outcomes;
}

/// Counts normalised innovations squared inside the two-sided 95 % band of their distribution.
class BandCount {
 public:
  void Add(const std::optional<double>& nis, int degrees_of_freedom) {
    if (!nis) return;
    // 2.5 and 97.5 % points of the chi-square distribution.
    const bool is_inside = degrees_of_freedom == 1 ? *nis >= 0.000982 && *nis <= 5.024
                                                   : *nis >= 0.0506 && *nis <= 7.378;
    inside_ += is_inside ? 1.0 : 0.0;
    ++count_;
  }
  void Add(const BandCount& other) {
    inside_ += other.inside_;
    count_ += other.count_;
  }
  json Percent() const { return count_ > 0.0 ? json(100.0 * inside_ / count_) : json(nullptr); }

 private:
  double inside_ = 0.0;
  double count_ = 0.0;
};

void AddInnovationFigures(const VelocityReport& report, json& figures) {
  BandCount gyro, accelerometer, optical, wheels, all;
  for (const DeadReckoned& step : report.run) {
    if (!report.drive.Holds(step.estimate.utime)) continue;
    const InnovationStatistics& nis = step.estimate.innovations;
    gyro.Add(nis.gyro, 1);
    accelerometer.Add(nis.accelerometer, 2);
    optical.Add(nis.ground_speed, 2);
    for (const std::optional<double>& wheel : nis.wheels) wheels.Add(wheel, 1);
  }
  for (const BandCount* part : {&gyro, &accelerometer, &optical, &wheels}) all.Add(*part);
  figures["nis_inside_percent"] = all.Percent();
  figures["nis"] = {{"gyro_inside_percent", gyro.Percent()},
                    {"accelerometer_inside_percent", accelerometer.Percent()},
                    {"optical_inside_percent", optical.Percent()},
                    {"wheels_inside_percent", wheels.Percent()}};
}

/// RMS of expected - measured over the drive; `residual` is empty where the run knows nothing.
template <class Reading, class Residual>
json RmsOf(const VelocityReport& report, const DeadReckoning& run,
           const std::vector<Reading>& readings, Residual residual) {
  std::vector<double> residuals;
  for (const Reading& reading : readings) {
    const std::optional<Eigen::Vector3d> velocity = VelocityAt(run, reading.utime);
    if (velocity && report.drive.Holds(reading.utime))
      residuals.push_back(residual(reading, *velocity));
  }
  return OrNull(RootMeanSquare(residuals));
}

json LeftOutFigures(const VelocityReport& report, const VelocityEstimatorParams& params) {
  const Car& car = params.car;
  const auto optical = [&](int axis) {
    return [&car, axis](const GroundSpeedReading& reading, const Eigen::Vector3d& v) {
      const Eigen::Vector2d& p = car.ground_speed_position;
      const Eigen::Vector2d there(v[0] - v[2] * p.y(), v[1] + v[2] * p.x());
      return there[axis] - reading.velocity[axis];
    };
  };
  // Both rear wheels: their mean does not depend on the yaw rate.
  const auto wheels = [&car](const MotorsReading& reading, const Eigen::Vector3d& v) {
    return v[0] - 0.5 * (reading.speed[2] + reading.speed[3]) * car.wheel_radius;
  };
  const auto gyro = [](const ImuReading& reading, const Eigen::Vector3d& v) {
    return v[2] - reading.yaw_rate;
  };
  return {
      {"optical",
       {{"vx_rms_mps",
         RmsOf(report, report.without_optical, report.recording.ground_speed, optical(0))},
        {"vy_rms_mps",
         RmsOf(report, report.without_optical, report.recording.ground_speed, optical(1))}}},
      {"wheels",
       {{"rear_speed_rms_mps",
         RmsOf(report, report.without_wheels, report.recording.motors, wheels)}}},
      {"imu",
       {{"yaw_rate_rms_radps", RmsOf(report, report.without_imu, report.recording.imu, gyro)}}}};
}

json FaultFigures(const std::vector<FaultOutcome>& faults) {
  json figures = json::object();
  for (const FaultOutcome& fault : faults) {
    figures[std::string(NameOf(fault.sensor))][std::string(NameOf(fault.kind))] = {
        {"max_mps", fault.max_mps},
        {"longest_s", fault.longest_s},
        {"valid", fault.is_always_valid},
        {"borne", fault.IsBorne()}};
  }
  return figures;
}

}  // namespace

DeadReckoning RunEstimator(const SensorRecording& recording,
                           const VelocityEstimatorParams& params) {
  Listener listener(params);
  auto imu = recording.imu.begin();
  auto ground_speed = recording.ground_speed.begin();
  auto motors = recording.motors.begin();
  constexpr int64_t kNever = std::numeric_limits<int64_t>::max();
  while (true) {
    const int64_t imu_utime = imu != recording.imu.end() ? imu->utime : kNever;
    const int64_t optical_utime =
        ground_speed != recording.ground_speed.end() ? ground_speed->utime : kNever;
    const int64_t motors_utime = motors != recording.motors.end() ? motors->utime : kNever;
    const int64_t next = std::min({imu_utime, optical_utime, motors_utime});
    if (next == kNever) return listener.TakeRun();
    // The IMU last: it leads, and hears what is as new as itself.
    if (motors_utime == next) {
      listener.Hear(*motors++);
    } else if (optical_utime == next) {
      listener.Hear(*ground_speed++);
    } else {
      listener.Hear(*imu++);
    }
  }
}

std::optional<PositionComparison> ComparePosition(const DeadReckoning& run,
                                                  const SensorRecording& recording,
                                                  const Drive& drive, const Car& car) {
  std::vector<Eigen::Vector2d> reckoned, measured;
  for (const GpsFix& fix : recording.gps) {
    const std::optional<Between> at = At(run, fix.utime);
    if (!at || !drive.Holds(fix.utime)) continue;
    const Eigen::Vector2d before = at->before->T_local_base * car.gnss_position;
    const Eigen::Vector2d after = at->after->T_local_base * car.gnss_position;
    reckoned.push_back(before + at->share * (after - before));
    measured.push_back(fix.position);
  }
  const std::optional<Pose2> T_enu_local = AlignRigidly(reckoned, measured);
  if (!T_enu_local) return std::nullopt;
  double sum = 0.0;
  for (size_t i = 0; i < measured.size(); ++i)
    sum += (*T_enu_local * reckoned[i] - measured[i]).squaredNorm();
  return PositionComparison{*T_enu_local, std::sqrt(sum / static_cast<double>(measured.size()))};
}

VelocityReport EvaluateVelocity(const SensorRecording& recording,
                                const VelocityEstimatorParams& params) {
  VelocityReport report;
  report.recording = recording;
  report.drive = DriveOf(recording, params.car.wheel_radius);
  report.run = RunEstimator(recording, params);
  report.position = ComparePosition(report.run, recording, report.drive, params.car);
  const auto run_without = [&](FaultySensor sensor) {
    constexpr int64_t kAlways = std::numeric_limits<int64_t>::min();
    return RunEstimator(WithFault(recording, sensor, FaultKind::kRemoved, kAlways), params);
  };
  report.without_imu = run_without(FaultySensor::kImu);
  report.without_optical = run_without(FaultySensor::kOptical);
  report.without_wheels = run_without(FaultySensor::kWheels);
  report.faults = TryFaults(report, params);
  return report;
}

json ToJson(const VelocityReport& report, const VelocityEstimatorParams& params) {
  const auto position = [&](const DeadReckoning& run, const Drive& window) {
    const auto comparison = ComparePosition(run, report.recording, window, params.car);
    return json{{"position_rms_m", comparison ? json(comparison->rms_m) : json(nullptr)}};
  };
  const Drive whole{report.recording.gps.front().utime, report.recording.gps.back().utime};
  json figures = position(report.run, report.drive);
  figures["position_rms_with_standstill_m"] = position(report.run, whole)["position_rms_m"];
  figures["drive_s"] = SecondsBetween(report.drive.from, report.drive.to);
  figures["distance_m"] = 0.0;
  for (size_t i = 1; i < report.run.size(); ++i) {
    figures["distance_m"] =
        figures["distance_m"].get<double>() +
        (report.run[i].T_local_base.position() - report.run[i - 1].T_local_base.position()).norm();
  }
  figures["without"] = {{"imu", position(report.without_imu, report.drive)},
                        {"optical", position(report.without_optical, report.drive)},
                        {"wheels", position(report.without_wheels, report.drive)},
                        {"gnss", position(report.run, report.drive)}};
  AddInnovationFigures(report, figures);
  figures["left_out"] = LeftOutFigures(report, params);
  figures["faults"] = FaultFigures(report.faults);
  figures["faults_borne"] = std::all_of(report.faults.begin(), report.faults.end(),
                                        [](const FaultOutcome& fault) { return fault.IsBorne(); });
  return figures;
}

}  // namespace hairpin
