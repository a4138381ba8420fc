#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "common/config.hpp"
#include "daemons/global_mapper/race_line/race_line.hpp"
#include "hairpin/race_line_t.hpp"

namespace hairpin {

/// Reads a section `race_line` but for `ahead_m`, and car.yaml. Problems are collected there.
RaceLineParams LoadRaceLineParams(const Config& config);

/// RACE_LINE for a pose of base in map and its covariance of (x, y, yaw): from 3 m behind the car
/// on `ahead` metres, or once round. Empty where the car is not on the line.
std::optional<race_line_t> RaceLineMessage(const RaceLine& line, int64_t utime,
                                           const Pose2& T_map_base,
                                           const Eigen::Matrix3d& covariance, double ahead);

}  // namespace hairpin
