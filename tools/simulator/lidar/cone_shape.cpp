#include "tools/simulator/lidar/cone_shape.hpp"

namespace hairpin {
namespace {

constexpr ConeShape kSmall{0.228, 0.025, 0.325, 0.085, 0.022};
constexpr ConeShape kLarge{0.285, 0.03, 0.505, 0.11, 0.028};
constexpr uint32_t kSides = 16;

// Lower and upper edge of a stripe, as shares of the cone's height; from pictures of the cones.
struct Stripe {
  double low, high;
};
constexpr Stripe kSmallStripe{0.42, 0.70};
constexpr Stripe kLargeStripes[2] = {{0.33, 0.50}, {0.62, 0.79}};

bool Within(const Stripe& stripe, double share) {
  return share >= stripe.low && share < stripe.high;
}

}  // namespace

const ConeShape& ShapeOf(ConeColour colour) {
  return colour == ConeColour::kOrangeLarge ? kLarge : kSmall;
}

TriangleMesh ConeMesh(ConeColour colour, const Eigen::Isometry3d& T_mesh_cone) {
  const ConeShape& shape = ShapeOf(colour);
  TriangleMesh mesh;
  const Eigen::Translation3d to_plate(0.0, 0.0, 0.5 * shape.plate_height);
  AddBox(T_mesh_cone * to_plate, {shape.base_width, shape.base_width, shape.plate_height}, mesh);
  const Eigen::Translation3d onto_plate(0.0, 0.0, shape.plate_height);
  AddFrustum(T_mesh_cone * onto_plate, shape.bottom_radius, shape.top_radius,
             shape.height - shape.plate_height, kSides, mesh);
  return mesh;
}

Material ConeMaterialAt(ConeColour colour, double height) {
  const double share = height / ShapeOf(colour).height;
  switch (colour) {
    case ConeColour::kBlue:
      return Within(kSmallStripe, share) ? Material::kWhiteStripe : Material::kBluePlastic;
    case ConeColour::kYellow:
      return Within(kSmallStripe, share) ? Material::kBlackStripe : Material::kYellowPlastic;
    case ConeColour::kOrange:
      return Within(kSmallStripe, share) ? Material::kWhiteStripe : Material::kOrangePlastic;
    case ConeColour::kOrangeLarge:
      return Within(kLargeStripes[0], share) || Within(kLargeStripes[1], share)
                 ? Material::kWhiteStripe
                 : Material::kOrangePlastic;
    case ConeColour::kUnknown:
      break;
  }
  return Material::kYellowPlastic;
}

}  // namespace hairpin
