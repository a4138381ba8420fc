#pragma once

#include <cmath>
#include <numbers>

#include "daemons/global_mapper/race_line/race_line.hpp"

namespace hairpin {

/// A closed centre line and the cones beside it.
struct SyntheticLap {
  Points driven;
  std::vector<MappedCone> cones;
};

/// Cones each `step` [m] beside a circle about the origin, driven counter-clockwise.
inline SyntheticLap CircularLap(double radius, double half_width, double step = 3.0) {
  SyntheticLap lap;
  const auto on = [](double r, double angle) {
    return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
  };
  for (int i = 0; i < 200; ++i) lap.driven.push_back(on(radius, 2.0 * std::numbers::pi * i / 200));
  for (const double side : {-1.0, 1.0}) {
    const double r = radius + side * half_width;
    const int count = static_cast<int>(std::ceil(2.0 * std::numbers::pi * r / step));
    for (int i = 0; i < count; ++i) {
      lap.cones.push_back({on(r, 2.0 * std::numbers::pi * i / count),
                           side < 0.0 ? ConeColour::kBlue : ConeColour::kYellow});
    }
  }
  return lap;
}

/// A lap with bends both ways and of different radius: r = 30 + 6 sin(3 angle) + 2 cos(5 angle).
inline SyntheticLap WavyLap(double half_width = 2.0) {
  SyntheticLap lap;
  const int count = 360;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const double r = 30.0 + 6.0 * std::sin(3.0 * angle) + 2.0 * std::cos(5.0 * angle);
    lap.driven.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  const ClosedCurve centre(lap.driven, 0.5);
  for (size_t i = 0; i < centre.size(); i += 6) {
    const Eigen::Vector2d out = half_width * centre.normal(i);
    lap.cones.push_back({centre.points()[i] + out, ConeColour::kBlue});
    lap.cones.push_back({centre.points()[i] - out, ConeColour::kYellow});
  }
  return lap;
}

inline Car TestCar() {
  Car car;
  car.mass = 190.0;
  car.front_axle = 0.72;
  car.rear_axle = 0.81;
  car.track_width = 1.2;
  car.front_overhang = 1.4;
  car.rear_overhang = 1.2;
  car.body_width = 1.4;
  return car;
}

inline RaceLineParams TestRaceLineParams() {
  RaceLineParams params;
  params.car = TestCar();
  params.corridor = {
      .spacing = 0.5, .smoothing_length = 1.5, .max_half_width = 6.0, .clearance = 0.3};
  params.line = {.max_iterations = 30, .max_step = 0.5, .tolerance = 0.02};
  params.speed = {.max_speed = 20.0,
                  .lateral_acceleration = 8.0,
                  .braking = 9.0,
                  .acceleration = 6.0,
                  .mass = 190.0,
                  .downforce = 0.0,
                  .drag = 0.0,
                  .rolling_resistance = 0.0,
                  .max_power = 80000.0};
  return params;
}

inline RaceLine Plan(const SyntheticLap& lap, const RaceLineParams& params = TestRaceLineParams()) {
  return PlanRaceLine(lap.cones, lap.driven, params);
}

}  // namespace hairpin
