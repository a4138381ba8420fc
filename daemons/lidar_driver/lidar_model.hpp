#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hairpin {

/// What a Velodyne sensor's design fixes. Its lasers fire in sequences, one after the other without
/// a gap, while the head turns clockwise; a packet's block of 32 returns holds one sequence or two.
struct VelodyneModel {
  std::string_view name;
  uint8_t product_id;           // last byte of a data packet
  double distance_step;         // [m]
  double sequence_period;       // [s]
  std::vector<double> firings;  // by channel: when it fires, from the sequence's beginning [s]

  size_t sequences_per_block() const { return 32 / firings.size(); }
};

/// The models that are understood: "VLP-32C" and "VLP-16". nullptr for any other name. Source:
/// Velodyne user manuals 63-9325 (VLP-32C) and 63-9243 (VLP-16), packet structure and firing times.
const VelodyneModel* FindVelodyneModel(std::string_view name);
std::vector<std::string> VelodyneModelNames();

/// The maker's name for a product id, as far as it is published; else "unknown sensor".
std::string_view VelodyneProductName(uint8_t product_id);

}  // namespace hairpin
