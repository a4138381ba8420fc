#include "daemons/lidar_driver/lidar_model.hpp"

#include <algorithm>

namespace hairpin {
namespace {

constexpr double kFiringPeriod = 2.304e-6;     // s, between one laser (or pair) and the next
constexpr double kSequencePeriod = 55.296e-6;  // s: all firings, and the lasers' recharging

VelodyneModel Model(std::string_view name, uint8_t product_id, double distance_step,
                    size_t channels, size_t at_once) {
  VelodyneModel model{name, product_id, distance_step, kSequencePeriod, {}};
  for (size_t channel = 0; channel < channels; ++channel) {
    const size_t firing = channel / at_once;
    model.firings.push_back(static_cast<double>(firing) * kFiringPeriod);
  }
  return model;
}

const std::vector<VelodyneModel>& Models() {
  static const std::vector<VelodyneModel> kModels{
      Model("VLP-32C", 0x28, 0.004, 32, 2),
      Model("VLP-16", 0x22, 0.002, 16, 1),
  };
  return kModels;
}

}  // namespace

const VelodyneModel* FindVelodyneModel(std::string_view name) {
  const auto& models = Models();
  const auto found = std::find_if(models.begin(), models.end(), [name](const VelodyneModel& model) {
    return model.name == name;
  });
  return found == models.end() ? nullptr : &*found;
}

std::vector<std::string> VelodyneModelNames() {
  std::vector<std::string> names;
  for (const VelodyneModel& model : Models()) names.emplace_back(model.name);
  return names;
}

std::string_view VelodyneProductName(uint8_t product_id) {
  switch (product_id) {
    case 0x21:
      return "HDL-32E";
    case 0x22:
      return "VLP-16";
    case 0x24:
      return "Puck Hi-Res";
    case 0x28:
      return "VLP-32C";
    case 0x31:
      return "Velarray";
    case 0xa1:
      return "VLS-128";
    default:
      return "unknown sensor";
  }
}

}  // namespace hairpin
