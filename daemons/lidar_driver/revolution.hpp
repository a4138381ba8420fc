#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemons/lidar_driver/packet_decoder.hpp"

namespace hairpin {

/// One turn of the head, from the cut to the cut.
struct Revolution {
  int64_t utime = 0;               // of its newest firing
  double covered_share = 0.0;      // of its azimuths whose packets arrived
  double column_step = 0.0;        // the head's turn between two firings of one ring [rad]
  int64_t packets = 0;             // used
  int64_t refused = 0;             // meanwhile
  std::vector<LidarPoint> points;  // age before utime
};

struct RevolutionParams {
  double cut_azimuth = 0.0;        // clockwise from x [rad]
  double max_refused_share = 0.0;  // of the packets; with more the revolution is not to be trusted
};

/// Cuts the stream of packets into revolutions.
class RevolutionAssembler {
 public:
  /// Throws std::invalid_argument unless the cut is finite and 0 <= max_refused_share <= 1.
  /// `column_period` [s]: as PacketDecoder.
  RevolutionAssembler(const RevolutionParams& params, double column_period);

  /// Whether the head has turned since the packet before, as far as time has passed; false for a
  /// head that stands still, or has turned back.
  bool Advances(const DecodedPacket& packet) const;

  /// Adds a packet whose first firing was at `utime`. Returns the revolution that it completes, if
  /// one was seen from its beginning, took no longer than its points' ages can say, and is
  /// to be trusted.
  std::optional<Revolution> Add(const DecodedPacket& packet, int64_t utime);

  void CountRefused() { ++current_.refused; }
  /// For when time has jumped: waits for the next beginning.
  void Reset();
  /// Revolutions given up: too many refused packets, or too long.
  int64_t given_up() const { return given_up_; }

 private:
  std::optional<Revolution> Complete();
  void AddColumns(const DecodedPacket& packet, size_t first, size_t last, int64_t utime);

  int cut_;  // [0.01 deg]
  double max_refused_share_;
  double column_period_;
  Revolution current_;
  int64_t begin_utime_ = 0;
  double covered_ = 0.0;  // [0.01 deg]
  int64_t columns_ = 0;
  bool from_its_beginning_ = false;
  std::optional<int> last_phase_;    // azimuth after the cut, of the last column [0.01 deg]
  std::optional<int> last_azimuth_;  // of the last packet's first column
  int64_t given_up_ = 0;
};

}  // namespace hairpin
