#include "tools/simulator/lidar/own_body.hpp"

#include <cmath>
#include <numbers>

namespace hairpin {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr float kReach = 6.0f;  // m: no part of the car is further from a sensor on it

void AddWheel(const Eigen::Vector2d& position, double radius, TriangleMesh& mesh) {
  constexpr double kWidth = 0.2;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(position.x(), position.y() + 0.5 * kWidth, radius));
  T.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  AddFrustum(T, radius, radius, kWidth, 20, mesh);
}

void AddPart(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, TriangleMesh& mesh) {
  AddBox(Upright(centre, 0.0), size, mesh);
}

// Shapes typical of a Formula Student car; lengths and widths that the car's file gives are its.
TriangleMesh BodyMesh(const Car& car) {
  TriangleMesh mesh;
  for (const Eigen::Vector2d& wheel : car.wheel_positions())
    AddWheel(wheel, car.wheel_radius, mesh);
  const double tip = car.front_overhang - 0.25;
  AddPart({0.5 * tip + 0.2, 0.0, 0.25}, {tip - 0.4, 0.36, 0.26}, mesh);  // nose
  AddPart({-0.4, 0.0, 0.35}, {1.2, 0.6, 0.45}, mesh);                    // cockpit, accumulator
  for (const double side : {-1.0, 1.0}) {
    AddPart({-0.3, 0.45 * side, 0.25}, {0.7, 0.25, 0.3}, mesh);    // sidepod
    AddPart({-0.25, 0.25 * side, 0.75}, {0.04, 0.04, 0.6}, mesh);  // leg of the main hoop
    AddPart({-car.rear_overhang + 0.25, 0.45 * side, 0.75}, {0.5, 0.02, 0.5}, mesh);
    AddPart({car.front_overhang - 0.25, (0.5 * car.body_width - 0.01) * side, 0.12},
            {0.5, 0.02, 0.18}, mesh);  // end plate of the front wing
  }
  AddPart({-0.25, 0.0, 1.03}, {0.04, 0.54, 0.04}, mesh);                     // main hoop
  AddPart({-car.rear_overhang + 0.25, 0.0, 0.95}, {0.45, 0.9, 0.03}, mesh);  // rear wing
  AddPart({car.front_overhang - 0.25, 0.0, 0.06}, {0.45, car.body_width, 0.03}, mesh);
  return mesh;
}

}  // namespace

Eigen::Vector3d BeamDirection(double elevation, double azimuth) {
  const double level = std::cos(elevation);
  return {level * std::cos(azimuth), -level * std::sin(azimuth), std::sin(elevation)};
}

OwnBody::OwnBody(const Car& car, const Surface& paint) : paint_(paint) {
  rays_.Add(BodyMesh(car));
  rays_.Commit();
}

OwnBody::Echo OwnBody::Cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  std::array<Eigen::Vector3f, kRaysPerBeam> directions;
  directions.fill(direction);
  const RayHit hit = rays_.Cast(origin, directions, kReach)[0];
  if (!std::isfinite(hit.range)) return {hit.range, 0.0f};
  return {hit.range, hairpin::Echo(paint_, hit.cosine)};
}

OwnBodyRanges::OwnBodyRanges(const OwnBody& body, const LidarModel& model,
                             const Eigen::Isometry3d& T_base_sensor) {
  const Eigen::Vector3f origin = T_base_sensor.translation().cast<float>();
  for (const Laser& laser : model.lasers) {
    for (size_t step = 0; step < kSteps; ++step) {
      const double azimuth = (static_cast<double>(step) + 0.5) * kTurn / kSteps;
      const Eigen::Vector3d direction =
          T_base_sensor.rotation() * BeamDirection(laser.elevation, azimuth);
      echoes_.push_back(body.Cast(origin, direction.cast<float>()));
    }
  }
}

const OwnBody::Echo& OwnBodyRanges::At(size_t channel, double azimuth) const {
  const double turns = azimuth / kTurn;
  const double share = turns - std::floor(turns);
  const size_t step = std::min(static_cast<size_t>(share * kSteps), kSteps - 1);
  return echoes_[channel * kSteps + step];
}

}  // namespace hairpin
