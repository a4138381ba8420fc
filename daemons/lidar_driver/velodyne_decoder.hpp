#pragma once

#include <string>
#include <vector>

#include "daemons/lidar_driver/lidar_model.hpp"
#include "daemons/lidar_driver/packet_decoder.hpp"

namespace hairpin {

/// Where one sensor's lasers look, by channel.
struct LidarCalibration {
  std::vector<double> elevation;       // [rad]
  std::vector<double> azimuth_offset;  // added to the head's azimuth, clockwise [rad]
};

struct VelodyneParams {
  std::string model;  // a name that FindVelodyneModel() knows
  LidarCalibration calibration;
  double min_range = 0.0;  // returns outside are left out [m]
  double max_range = 0.0;
};

/// Velodyne data packets: 1206 bytes, 12 blocks of flag 0xFFEE, azimuth and 32 returns of 3 bytes
/// (range, intensity), then a time stamp, return mode and product id. In dual return mode blocks
/// come in pairs of one azimuth. Sources: user manuals 63-9325 (VLP-32C) and 63-9243 (VLP-16).
///
/// The azimuth of a laser is the block's, plus the head's turn until that laser fires (linear to
/// the next block's azimuth), plus the laser's own offset. A sensor that is
/// set to a part of the circle jumps over the rest, in the midst of a packet: time has then gone on
/// by as much as the head needs for it.
class VelodyneDecoder final : public PacketDecoder {
 public:
  /// Throws std::invalid_argument for an unknown model, a calibration of another number of lasers,
  /// an angle that is not finite, or ranges that are not 0 <= min < max.
  explicit VelodyneDecoder(const VelodyneParams& params);

  bool IsDataSize(size_t size) const override;
  std::optional<Refused> Decode(std::span<const uint8_t> packet,
                                DecodedPacket& decoded) const override;
  std::string_view model() const override { return model_.name; }
  const std::vector<float>& ring_elevations() const override { return ring_elevations_; }
  double column_period() const override { return model_.sequence_period; }

 private:
  struct Laser {
    float cos_elevation;
    float sin_elevation;
    float azimuth_offset;  // [0.01 deg]
    float turn;            // share of a block's turn until it fires
    float time;            // from the block's beginning [s]
    uint8_t ring;
  };

  std::optional<Refused> Problem(std::span<const uint8_t> packet) const;
  void DecodeBlock(const uint8_t* block, const uint8_t* twin, float azimuth, float turn, float time,
                   DecodedPacket& decoded) const;
  void DecodeReturn(const uint8_t* data, const Laser& laser, float azimuth, float time,
                    DecodedPacket& decoded) const;

  const VelodyneModel& model_;
  int min_distance_;  // [distance steps]
  int max_distance_;
  std::vector<Laser> lasers_;  // of the 32 returns of a block
  std::vector<float> ring_elevations_;
};

}  // namespace hairpin
