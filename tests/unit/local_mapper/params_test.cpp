#include "tests/unit/local_mapper/params.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace hairpin {
namespace {

struct BadParameter {
  const char* names;  // what the message must name
  std::function<void(LocalMapperParams&)> spoil;
};

TEST(LocalMapper, RefusesParametersOutOfRangeByName) {
  using P = LocalMapperParams;
  const std::vector<BadParameter> bad{
      {"gate_chi2", [](P& p) { p.map.association.gate_chi2 = 0.0; }},
      {"gate_sigma", [](P& p) { p.map.association.gate_sigma = -0.1; }},
      {"min_cone_distance", [](P& p) { p.map.min_cone_distance = -1.0; }},
      {"position_sigma", [](P& p) { p.map.odometry.position_sigma = -1.0; }},
      {"yaw_sigma", [](P& p) { p.map.odometry.yaw_sigma = std::nan(""); }},
      {"unknown_colour_weight", [](P& p) { p.map.unknown_colour_weight = 0.0; }},
      {"removed_below", [](P& p) { p.map.existence.removed_below = 0.0; }},
      {"at_first_sight", [](P& p) { p.map.existence.at_first_sight = 0.3; }},
      {"existence max", [](P& p) { p.map.existence.max = 0.5; }},
      {"existence max", [](P& p) { p.map.existence.max = 1.0; }},
      {"max_credited_recall", [](P& p) { p.map.existence.max_credited_recall = 1.0; }},
      {"bearing_margin", [](P& p) { p.map.visibility.bearing_margin = -0.1; }},
      {"range_margin", [](P& p) { p.map.visibility.range_margin = -0.1; }},
      {"occlusion_half_width", [](P& p) { p.map.visibility.occlusion_half_width = 0.0; }},
      {"ranges must be >= 2",
       [](P& p) {
         p.map.detector[0].recall = {{5.0}, {0.9}};
       }},
      {"ranges must rise",
       [](P& p) {
         p.map.detector[1].recall = {{5.0, 5.0}, {0.9, 0.8}};
       }},
      {"recalls must be as many",
       [](P& p) {
         p.map.detector[2].recall = {{1.0, 5.0}, {0.9}};
       }},
      {"recalls must be in",
       [](P& p) {
         p.map.detector[0].recall = {{1.0, 5.0}, {1.1, 0.8}};
       }},
      {"false_positive", [](P& p) { p.map.detector[0].false_positive = 0.0; }},
      {"forget_distance", [](P& p) { p.map.forget_distance = 0.0; }},
      {"forget_radius", [](P& p) { p.map.forget_radius = -1.0; }},
      {"max_cones", [](P& p) { p.map.max_cones = 0; }},
      {"position_weight", [](P& p) { p.trust.camera_only.position_weight = 0.0; }},
      {"colour_weight", [](P& p) { p.trust.fusion.colour_weight = -1.0; }},
      {"history", [](P& p) { p.history = 0.4; }},
      {"velocity_deadline", [](P& p) { p.velocity_deadline = 0.0; }},
      {"max_velocity_gap", [](P& p) { p.max_velocity_gap = 0.05; }},
      {"gap_acceleration", [](P& p) { p.gap_acceleration = -1.0; }},
      {"gap_yaw_acceleration", [](P& p) { p.gap_yaw_acceleration = -1.0; }},
      {"max_speed", [](P& p) { p.max_speed = 0.0; }},
      {"max_yaw_rate", [](P& p) { p.max_yaw_rate = 0.0; }},
      {"cycle", [](P& p) { p.cycle = 0.0; }},
      {"max_observations", [](P& p) { p.max_observations = 0; }},
  };
  EXPECT_NO_THROW(LocalMapper{test::TestMapperParams()});
  for (const BadParameter& each : bad) {
    LocalMapperParams params = test::TestMapperParams();
    each.spoil(params);
    EXPECT_THAT([&] { LocalMapper{params}; },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(each.names)));
  }
}

}  // namespace
}  // namespace hairpin
