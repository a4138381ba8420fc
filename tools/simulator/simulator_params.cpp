#include "tools/simulator/simulator_params.hpp"

#include <numbers>
#include <stdexcept>

#include "tools/simulator/lidar/lidar_params.hpp"

namespace hairpin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Range kShare{0.0, 1.0};

TyreParams LoadTyre(const Config& config) {
  TyreParams params;
  params.stiffness_factor = config.Number("stiffness_factor", {1.0, 100.0});
  params.shape_factor = config.Number("shape_factor", {1.0, 2.0});
  params.peak_friction = config.Number("peak_friction", {0.1, 3.0});
  params.curvature_factor = config.Number("curvature_factor", {-10.0, 1.0});
  params.load_sensitivity = config.Number("load_sensitivity", {0.0, 0.25});
  params.longitudinal_relaxation_m = config.Number("longitudinal_relaxation_m", {0.05, 1.0});
  params.lateral_relaxation_m = config.Number("lateral_relaxation_m", {0.05, 1.0});
  params.standstill_damping_nspm = config.Number("standstill_damping_nspm", {0.0, 3000.0});
  params.standstill_speed_mps = config.Number("standstill_speed_mps", {0.1, 5.0});
  return params;
}

VehicleParams LoadVehicle(const Config& config) {
  VehicleParams params;
  params.tyre = LoadTyre(config.Section("tyre"));
  params.wheel_inertia_kgm2 = config.Number("wheel_inertia_kgm2", {0.1, 5.0});
  params.drag_ns2pm2 = config.Number("drag_ns2pm2", {0.0, 10.0});
  params.downforce_ns2pm2 = config.Number("downforce_ns2pm2", {0.0, 10.0});
  params.downforce_front_share = config.Number("downforce_front_share", kShare);
  params.rolling_resistance_n = config.Number("rolling_resistance_n", {0.0, 1000.0});
  params.front_roll_share = config.Number("front_roll_share", kShare);
  params.load_transfer_time_s = config.Number("load_transfer_time_s", {0.005, 1.0});
  params.steering_delay_s = config.Number("steering_delay_s", {0.0, 0.5});
  params.steering_rate_radps = config.Number("steering_rate_radps", {0.1, 20.0});
  params.motor_time_constant_s = config.Number("motor_time_constant_s", {0.002, 1.0});
  params.max_motor_power_w = config.Number("max_motor_power_w", {1000.0, 500000.0});
  params.regeneration_fade_mps = config.Number("regeneration_fade_mps", {0.1, 5.0});
  params.brake_time_constant_s = config.Number("brake_time_constant_s", {0.002, 1.0});
  return params;
}

ActuatorParams LoadActuators(const Config& config) {
  ActuatorParams params;
  params.hold_after_s = config.Number("hold_after_s", {0.01, 0.5});
  params.brake_after_s = config.Number("brake_after_s", {params.hold_after_s, 0.5});
  params.emergency_after_s = config.Number("emergency_after_s", {params.brake_after_s, 0.5});
  params.state_timeout_s = config.Number("state_timeout_s", {0.05, 1.0});
  params.deadman_brake = config.Number("deadman_brake", kShare);
  params.parking_brake = config.Number("parking_brake", kShare);
  return params;
}

void LoadInertial(const Config& config, MotionSensorParams& params) {
  params.gyro_noise_radps = kDegree * config.Number("gyro_noise_degps", {0.0, 10.0});
  params.gyro_bias_radps = kDegree * config.Number("gyro_bias_degps", {0.0, 10.0});
  params.gyro_scale = config.Number("gyro_scale", {0.0, 0.1});
  params.accelerometer_noise_mps2 = config.Number("accelerometer_noise_mps2", {0.0, 5.0});
  params.accelerometer_bias_mps2 = config.Number("accelerometer_bias_mps2", {0.0, 5.0});
  params.accelerometer_scale = config.Number("accelerometer_scale", {0.0, 0.1});
  params.imu_bias_time_s = config.Number("bias_time_s", {1.0, 1e5});
}

int32_t LoadGnssFix(const Config& config) {
  const std::string fix = config.Text("fix");
  if (fix == "single") return gnss_t::FIX_SINGLE;
  if (fix == "differential") return gnss_t::FIX_DIFFERENTIAL;
  if (fix == "float") return gnss_t::FIX_FLOAT;
  if (fix == "rtk") return gnss_t::FIX_RTK;
  throw ConfigError("simulator: motion_sensors.gnss.fix: `" + fix +
                    "` is none of single, differential, float, rtk");
}

MotionSensorParams LoadMotionSensors(const Config& config) {
  MotionSensorParams params;
  LoadInertial(config.Section("imu"), params);
  const Config wheels = config.Section("wheels");
  params.wheel_speed_noise_radps = wheels.Number("speed_noise_radps", {0.0, 10.0});
  params.wheel_torque_noise_nm = wheels.Number("torque_noise_nm", {0.0, 100.0});
  params.wheel_torque_scale = wheels.Number("torque_scale", {0.0, 0.2});
  const Config steering = config.Section("steering");
  params.steering_noise_rad = kDegree * steering.Number("noise_deg", {0.0, 5.0});
  params.steering_offset_rad = kDegree * steering.Number("offset_deg", {0.0, 5.0});
  const Config ground_speed = config.Section("ground_speed");
  params.ground_speed_noise_mps = ground_speed.Number("noise_mps", {0.0, 5.0});
  params.ground_speed_scale = ground_speed.Number("scale", {0.0, 0.1});
  params.ground_speed_misalignment_rad =
      kDegree * ground_speed.Number("misalignment_deg", {0.0, 5.0});
  const Config gnss = config.Section("gnss");
  params.gnss_fix = LoadGnssFix(gnss);
  params.gnss_position_bias_m = gnss.Number("position_bias_m", {0.0, 10.0});
  params.gnss_position_bias_time_s = gnss.Number("position_bias_time_s", {1.0, 1e5});
  params.gnss_position_noise_m = gnss.Number("position_noise_m", {0.001, 10.0});
  params.gnss_velocity_noise_mps = gnss.Number("velocity_noise_mps", {0.001, 5.0});
  params.gnss_heading_noise_rad = kDegree * gnss.Number("heading_noise_deg", {0.01, 10.0});
  return params;
}

GnssReceiverParams LoadGnssReceiver(const Config& config) {
  GnssReceiverParams params;
  const std::string protocol = config.Text("protocol");
  if (protocol != "ubx" && protocol != "nmea")
    throw ConfigError("simulator: gnss_receiver.protocol: `" + protocol +
                      "` is neither ubx nor nmea");
  params.protocol = protocol == "ubx" ? GnssProtocol::kUbx : GnssProtocol::kNmea;
  params.origin = {config.Number("latitude_deg", {-90.0, 90.0}),
                   config.Number("longitude_deg", {-180.0, 180.0}),
                   config.Number("height_m", {-500.0, 9000.0})};
  return params;
}

// Two lists of the same length: `ranges_key`, and `key` with the values there.
PiecewiseLinear LoadTable(const Config& config, const std::string& ranges_key,
                          const std::string& key, const Range& range) {
  const std::vector<double> knots = config.Numbers(ranges_key, 0, {0.0, 100.0});
  const std::vector<double> values = config.Numbers(key, knots.size(), range);
  try {
    return PiecewiseLinear(ranges_key, knots, values);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(std::string("simulator: ") + key + ": " + error.what());
  }
}

ConeSensorParams LoadConeSensor(const Config& config) {
  ConeSensorParams params;
  params.half_field_of_view_rad = kDegree * config.Number("half_field_of_view_deg", {6.0, 180.0});
  params.max_range_m = config.Number("max_range_m", {1.0, 100.0});
  params.phase_s = config.Number("phase_s", {0.0, 0.09});
  params.recall = LoadTable(config, "recall_ranges_m", "recall", kShare);
  params.radial_noise_m = LoadTable(config, "noise_ranges_m", "radial_noise_m", {0.001, 5.0});
  params.tangential_noise_m =
      LoadTable(config, "noise_ranges_m", "tangential_noise_m", {0.001, 5.0});
  params.colour_correct = LoadTable(config, "colour_ranges_m", "colour_correct", kShare);
  params.colour_wrong = LoadTable(config, "colour_ranges_m", "colour_wrong", kShare);
  params.sees_orange = config.Flag("sees_orange");
  params.false_positives_per_m =
      LoadTable(config, "false_positive_ranges_m", "false_positives_per_m", kShare);
  params.clutter_probability = config.Number("clutter_probability", kShare);
  params.phantom_unknown_probability = config.Number("phantom_unknown_probability", kShare);
  return params;
}

RefereeParams LoadReferee(const Config& config) {
  RefereeParams params;
  params.laps = config.Integer("laps", 1, 1000);
  params.start_limit_s = config.Number("start_limit_s", {1.0, 600.0});
  params.time_limit_per_lap_s = config.Number("time_limit_per_lap_s", {1.0, 3600.0});
  params.stop_distance_m = config.Number("stop_distance_m", {1.0, 200.0});
  params.finish_limit_s = config.Number("finish_limit_s", {1.0, 600.0});
  params.no_movement_limit_s = config.Number("no_movement_limit_s", {1.0, 600.0});
  params.standstill_mps = config.Number("standstill_mps", {0.001, 1.0});
  params.braking_distance_m = config.Number("braking_distance_m", {0.0, 100.0});
  return params;
}

RaceControlParams LoadRaceControl(const Config& config) {
  RaceControlParams params;
  params.mission =
      config.Integer("mission", vehicle_t::MISSION_ACCELERATION, vehicle_t::MISSION_AUTOCROSS);
  params.go_after_ready_s = config.Number("go_after_ready_s", {5.0, 60.0});
  params.brakes_engaged_pressure = config.Number("brakes_engaged_pressure", kShare);
  params.res_stop_speed_mps = config.Number("res_stop_speed_mps", {0.0, 40.0});
  return params;
}

}  // namespace

SimulatorParams LoadSimulatorParams(const Config& config) {
  SimulatorParams params;
  params.vehicle = LoadVehicle(config.Section("vehicle"));
  params.actuators = LoadActuators(config.Section("actuators"));
  params.motion_sensors = LoadMotionSensors(config.Section("motion_sensors"));
  params.gnss_receiver = LoadGnssReceiver(config.Section("gnss_receiver"));
  const Config cones = config.Section("cone_sensors");
  params.cone_delay_s = cones.Number("delay_s", {0.0, 0.5});
  params.fusion = LoadConeSensor(cones.Section("fusion"));
  params.lidar = LoadConeSensor(cones.Section("lidar"));
  params.camera = LoadConeSensor(cones.Section("camera"));
  params.lidars = LoadLidarRigParams(config);
  params.referee = LoadReferee(config.Section("referee"));
  params.race_control = LoadRaceControl(config.Section("race_control"));
  config.Finish();
  return params;
}

}  // namespace hairpin
