#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numeric>

#include "common/cone.hpp"
#include "tests/support/simulator_setup.hpp"
#include "tools/simulator/cone_sensor.hpp"

namespace hairpin {
namespace {

constexpr int kScans = 20000;

ConeSensorParams Quiet(ConeSensorParams params) {
  params.false_positives_per_m = PiecewiseLinear(0.0);
  return params;
}

TrackCone ConeAt(double range, double bearing, ConeColour colour = ConeColour::kBlue) {
  return {{range * std::cos(bearing), range * std::sin(bearing)}, colour};
}

// Share of scans that report the only cone there is.
double Recall(const ConeSensorParams& params, double range, double bearing = 0.3) {
  ConeSensor sensor(Quiet(params), "test", 7);
  int seen = 0;
  for (int i = 0; i < kScans; ++i)
    seen += sensor.Scan(i, {}, {ConeAt(range, bearing)}, {}).num_cones;
  return static_cast<double>(seen) / kScans;
}

TEST(ConeSensor, RecallsByRangeAsItsTableSays) {
  const SimulatorParams params = ShippedSimulatorParams();
  for (const ConeSensorParams& sensor : {params.fusion, params.lidar, params.camera}) {
    for (const double range : {2.0, 5.0, 8.0, 11.0, 14.0, 16.0, 19.0, 23.0}) {
      EXPECT_NEAR(Recall(sensor, range), range > sensor.max_range_m ? 0.0 : sensor.recall(range),
                  0.012)
          << range;
    }
  }
}

TEST(ConeSensor, IsNoBetterThanRealPipelinesWere) {
  const SimulatorParams params = ShippedSimulatorParams();
  const std::map<double, double> best{
      {5.0, 0.93}, {11.0, 0.89}, {14.0, 0.74}, {16.0, 0.39}, {22.0, 0.0}};
  for (const ConeSensorParams& sensor : {params.fusion, params.lidar, params.camera}) {
    for (const auto& [range, recall] : best) EXPECT_LE(sensor.recall(range), recall) << range;
    EXPECT_LE(sensor.max_range_m, 22.0);
  }
}

TEST(ConeSensor, SeesOnlyWithinItsFieldOfViewAndSaysSo) {
  const ConeSensorParams params = ShippedSimulatorParams().camera;
  EXPECT_GT(Recall(params, 5.0, params.half_field_of_view_rad - 0.01), 0.9);
  EXPECT_EQ(Recall(params, 5.0, params.half_field_of_view_rad + 0.01), 0.0);
  const cones_t scan = ConeSensor(params, "test", 1).Scan(5, {}, {}, {});
  ASSERT_EQ(scan.num_sectors, 1);
  EXPECT_FLOAT_EQ(scan.sectors[0].max_bearing_rad,
                  static_cast<float>(params.half_field_of_view_rad));
  EXPECT_FLOAT_EQ(scan.sectors[0].min_bearing_rad,
                  -static_cast<float>(params.half_field_of_view_rad));
  EXPECT_FLOAT_EQ(scan.sectors[0].max_range_m, static_cast<float>(params.max_range_m));
  EXPECT_EQ(scan.utime, 5);
}

TEST(ConeSensor, StatesTheCovarianceOfItsErrors) {
  const SimulatorParams all = ShippedSimulatorParams();
  for (const ConeSensorParams& params : {all.lidar, all.camera}) {
    ConeSensor sensor(Quiet(params), "test", 3);
    const TrackCone cone = ConeAt(9.0, 0.6);
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    double normalised = 0.0;
    int count = 0;
    for (int i = 0; i < kScans; ++i) {
      for (const cone_observation_t& message : sensor.Scan(i, {}, {cone}, {}).cones) {
        const auto observation = ToConeObservation(message);
        ASSERT_TRUE(observation);
        const Eigen::Vector2d error = observation->position - cone.position;
        sum += error * error.transpose();
        normalised += error.dot(observation->covariance.inverse() * error);
        ++count;
      }
    }
    EXPECT_NEAR(normalised / count, 2.0, 0.08);  // chi-square of two degrees of freedom
    const Eigen::Matrix2d empirical = RotateCovariance(sum / count, -0.6);
    EXPECT_NEAR(std::sqrt(empirical(0, 0)), params.radial_noise_m(9.0),
                0.03 * params.radial_noise_m(9.0));
    EXPECT_NEAR(std::sqrt(empirical(1, 1)), params.tangential_noise_m(9.0),
                0.03 * params.tangential_noise_m(9.0));
  }
}

TEST(ConeSensor, ConfusesColoursByRangeAndIsCalibrated) {
  const ConeSensorParams params = ShippedSimulatorParams().lidar;
  for (const double range : {6.0, 10.0, 14.0}) {
    ConeSensor sensor(Quiet(params), "test", 11);
    std::map<ConeColour, int> labels;
    int count = 0;
    for (int i = 0; i < kScans; ++i) {
      for (const cone_observation_t& message : sensor.Scan(i, {}, {ConeAt(range, 0.0)}, {}).cones) {
        const double sum =
            std::accumulate(std::begin(message.probability), std::end(message.probability), 0.0);
        EXPECT_NEAR(sum, 1.0, 1e-6);
        ++labels[MostProbable(ToConeObservation(message)->colour)];
        ++count;
      }
    }
    EXPECT_NEAR(1.0 * labels[ConeColour::kBlue] / count, params.colour_correct(range), 0.015)
        << range;
    EXPECT_NEAR(1.0 * labels[ConeColour::kYellow] / count, params.colour_wrong(range), 0.015)
        << range;
  }
}

TEST(ConeSensor, SeesOrangeOnlyWithColour) {
  const SimulatorParams params = ShippedSimulatorParams();
  const std::vector<TrackCone> cones{ConeAt(4.0, 0.0, ConeColour::kOrangeLarge)};
  const auto orange = [&](const ConeSensorParams& sensor_params) {
    ConeSensor sensor(Quiet(sensor_params), "test", 5);
    int count = 0;
    for (int i = 0; i < 1000; ++i) {
      for (const auto& cone : sensor.Scan(i, {}, cones, {}).cones)
        count += cone.probability[4] > 0.5f ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(orange(params.lidar), 0);
  EXPECT_GT(orange(params.fusion), 850);
  EXPECT_GT(orange(params.camera), 850);
}

TEST(ConeSensor, InventsConesAtItsRateInsideItsView) {
  const ConeSensorParams params = ShippedSimulatorParams().fusion;
  ConeSensor sensor(params, "test", 13);
  double expected = 0.0;
  for (double range = 1.5; range < params.max_range_m; range += 1.0)
    expected += params.false_positives_per_m(range);
  int count = 0;
  for (int i = 0; i < kScans; ++i) {
    for (const auto& cone : sensor.Scan(i, {}, {}, {}).cones) {
      ++count;
      EXPECT_LT(std::hypot(cone.x_m, cone.y_m), params.max_range_m + 1.0);
      EXPECT_LT(std::abs(std::atan2(cone.y_m, cone.x_m)), params.half_field_of_view_rad + 0.5);
    }
  }
  EXPECT_NEAR(1.0 * count / kScans, expected, 0.1 * expected);
  EXPECT_NEAR(expected, 0.1, 0.03);
}

TEST(ConeSensor, TakesClutterForConesAtItsProbability) {
  const ConeSensorParams params = ShippedSimulatorParams().lidar;
  ConeSensor sensor(Quiet(params), "test", 17);
  int count = 0;
  for (int i = 0; i < kScans; ++i) count += sensor.Scan(i, {}, {}, {{6.0, 2.0}}).num_cones;
  EXPECT_NEAR(1.0 * count / kScans,
              params.clutter_probability * params.recall(std::hypot(6.0, 2.0)), 0.012);
}

TEST(ConeSensor, ReportsInBase) {
  ConeSensorParams params = Quiet(ShippedSimulatorParams().fusion);
  params.recall = PiecewiseLinear(1.0);
  params.radial_noise_m = PiecewiseLinear(0.001);
  params.tangential_noise_m = PiecewiseLinear(0.001);
  const Pose2 T_map_base{10.0, 20.0, 1.2};
  const TrackCone cone{T_map_base * Eigen::Vector2d(5.0, -2.0), ConeColour::kYellow};
  const cones_t scan = ConeSensor(params, "test", 1).Scan(0, T_map_base, {cone}, {});
  ASSERT_EQ(scan.num_cones, 1);
  EXPECT_NEAR(scan.cones[0].x_m, 5.0, 0.01);
  EXPECT_NEAR(scan.cones[0].y_m, -2.0, 0.01);
}

TEST(ConeSensor, RefusesParametersThatCannotBe) {
  ConeSensorParams params = ShippedSimulatorParams().fusion;
  params.recall = PiecewiseLinear(1.5);
  EXPECT_THROW(ConeSensor(params, "test", 1), std::invalid_argument);
  params = ShippedSimulatorParams().fusion;
  params.colour_correct = PiecewiseLinear(0.8);
  params.colour_wrong = PiecewiseLinear(0.3);
  EXPECT_THROW(ConeSensor(params, "test", 1), std::invalid_argument);
}

TEST(PiecewiseLinear, IsStraightBetweenKnotsAndConstantBeyond) {
  const PiecewiseLinear function("f", {1.0, 3.0}, {10.0, 20.0});
  EXPECT_EQ(function(0.0), 10.0);
  EXPECT_EQ(function(1.0), 10.0);
  EXPECT_EQ(function(2.0), 15.0);
  EXPECT_EQ(function(9.0), 20.0);
  EXPECT_THROW(PiecewiseLinear("f", {1.0, 1.0}, {1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(PiecewiseLinear("f", {1.0, 2.0}, {1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace hairpin
