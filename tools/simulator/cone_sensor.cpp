#include "tools/simulator/cone_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/simulator/require.hpp"

namespace hairpin {
namespace {

constexpr double kMinRange = 0.5;  // m: within the car's own body

void CheckAll(const std::string& name, const PiecewiseLinear& function, double min, double max) {
  for (const double value : function.values()) RequireWithin(name, value, min, max);
}

void Check(const ConeSensorParams& params, const std::string& name) {
  RequireWithin(name + ".half_field_of_view", params.half_field_of_view_rad, 0.1, std::numbers::pi);
  RequireWithin(name + ".max_range", params.max_range_m, 1.0, 100.0);
  RequireWithin(name + ".phase", params.phase_s, 0.0, 0.1);
  CheckAll(name + ".recall", params.recall, 0.0, 1.0);
  CheckAll(name + ".radial_noise", params.radial_noise_m, 1e-3, 5.0);
  CheckAll(name + ".tangential_noise", params.tangential_noise_m, 1e-3, 5.0);
  CheckAll(name + ".colour_correct", params.colour_correct, 0.0, 1.0);
  CheckAll(name + ".colour_wrong", params.colour_wrong, 0.0, 1.0);
  CheckAll(name + ".false_positives_per_m", params.false_positives_per_m, 0.0, 1.0);
  RequireWithin(name + ".clutter_probability", params.clutter_probability, 0.0, 1.0);
  RequireWithin(name + ".phantom_unknown_probability", params.phantom_unknown_probability, 0.0,
                1.0);
  for (double range = 0.0; range <= params.max_range_m; range += 0.5) {
    RequireWithin(name + ".colour_correct + colour_wrong",
                  params.colour_correct(range) + params.colour_wrong(range), 0.0, 1.0);
  }
}

// What "wrong" means: the other side's cone, or the other size of orange.
ConeColour Confused(ConeColour colour) {
  switch (colour) {
    case ConeColour::kBlue:
      return ConeColour::kYellow;
    case ConeColour::kYellow:
      return ConeColour::kBlue;
    case ConeColour::kOrange:
      return ConeColour::kOrangeLarge;
    case ConeColour::kOrangeLarge:
      return ConeColour::kOrange;
    case ConeColour::kUnknown:
      break;
  }
  return ConeColour::kUnknown;
}

}  // namespace

ConeSensor::ConeSensor(const ConeSensorParams& params, const std::string& name, uint64_t seed)
    : params_(params), random_(seed, name) {
  Check(params, name);
}

bool ConeSensor::InView(const Eigen::Vector2d& position_base) const {
  const double range = position_base.norm();
  return range >= kMinRange && range <= params_.max_range_m &&
         std::abs(std::atan2(position_base.y(), position_base.x())) <=
             params_.half_field_of_view_rad;
}

cones_t ConeSensor::Scan(int64_t utime, const Pose2& T_map_base,
                         const std::vector<TrackCone>& cones,
                         const std::vector<Eigen::Vector2d>& clutter) {
  cones_t message{};
  message.utime = utime;
  const Pose2 T_base_map = T_map_base.Inverse();
  for (const TrackCone& cone : cones) {
    const Eigen::Vector2d position = T_base_map * cone.position;
    if (!InView(position) || !random_.Chance(params_.recall(position.norm()))) continue;
    message.cones.push_back(Observe(position, Classify(cone.colour, position.norm())));
  }
  for (const Eigen::Vector2d& thing : clutter) {
    const Eigen::Vector2d position = T_base_map * thing;
    if (!InView(position) ||
        !random_.Chance(params_.clutter_probability * params_.recall(position.norm())))
      continue;
    message.cones.push_back(Observe(position, ClassifyPhantom(position.norm())));
  }
  AddFalsePositives(message.cones);
  message.num_cones = static_cast<int32_t>(message.cones.size());
  const auto half = static_cast<float>(params_.half_field_of_view_rad);
  message.sectors.push_back({});
  message.sectors[0].min_bearing_rad = -half;
  message.sectors[0].max_bearing_rad = half;
  message.sectors[0].max_range_m = static_cast<float>(params_.max_range_m);
  message.num_sectors = 1;
  return message;
}

void ConeSensor::AddFalsePositives(std::vector<cone_observation_t>& observations) {
  // At most one in each metre of range, which is what a rate well below 1 means.
  for (double from = std::ceil(kMinRange); from + 1.0 <= params_.max_range_m; from += 1.0) {
    if (!random_.Chance(params_.false_positives_per_m(from + 0.5))) continue;
    const double range = random_.Uniform(from, from + 1.0);
    const double bearing =
        random_.Uniform(-params_.half_field_of_view_rad, params_.half_field_of_view_rad);
    const Eigen::Vector2d position(range * std::cos(bearing), range * std::sin(bearing));
    observations.push_back(Observe(position, ClassifyPhantom(range)));
  }
}

cone_observation_t ConeSensor::Observe(const Eigen::Vector2d& position_base,
                                       const ColourDistribution& colour) {
  const double true_range = position_base.norm();
  const Eigen::Vector2d radial = position_base / true_range;
  const Eigen::Vector2d tangential(-radial.y(), radial.x());
  ConeObservation observation;
  observation.position = position_base +
                         random_.Gaussian(params_.radial_noise_m(true_range)) * radial +
                         random_.Gaussian(params_.tangential_noise_m(true_range)) * tangential;
  // A sensor knows its noise only at the range that it has measured.
  const double range = observation.position.norm();
  const double bearing = std::atan2(observation.position.y(), observation.position.x());
  const double radial_sigma = params_.radial_noise_m(range);
  const double tangential_sigma = params_.tangential_noise_m(range);
  const Eigen::Vector2d variances(radial_sigma * radial_sigma, tangential_sigma * tangential_sigma);
  observation.covariance = RotateCovariance(variances.asDiagonal(), bearing);
  observation.colour = colour;
  return ToMessage(observation);
}

ColourDistribution ConeSensor::Classify(ConeColour colour, double range) {
  const double correct = params_.colour_correct(range);
  const double wrong = params_.colour_wrong(range);
  const double draw = random_.Uniform();
  const bool is_orange = colour == ConeColour::kOrange || colour == ConeColour::kOrangeLarge;
  const bool has_class = colour != ConeColour::kUnknown && (params_.sees_orange || !is_orange);
  if (!has_class || draw >= correct + wrong) return kColourUnknown;
  const ConeColour label = draw < correct ? colour : Confused(colour);
  // Calibrated: of the cones with this label, this share is of its colour.
  ColourDistribution distribution{};
  distribution[static_cast<size_t>(label)] = correct / (correct + wrong);
  distribution[static_cast<size_t>(Confused(label))] = wrong / (correct + wrong);
  return distribution;
}

ColourDistribution ConeSensor::ClassifyPhantom(double range) {
  if (random_.Chance(params_.phantom_unknown_probability)) return kColourUnknown;
  return Classify(random_.Chance(0.5) ? ConeColour::kBlue : ConeColour::kYellow, range);
}

}  // namespace hairpin
