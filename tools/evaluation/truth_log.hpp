#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemons/gnss_driver/gnss_driver_node.hpp"
#include "hairpin/truth_t.hpp"
#include "tools/report/run_log.hpp"
#include "tools/simulator/track.hpp"

namespace hairpin {

/// What a receiver said, as GNSS messages in map, in order of time.
struct ReceiverRecording {
  std::vector<gnss_t> fixes;
  std::map<std::string, int64_t> bad_frames;  // by reason
};

/// A recording of the receiver's own bytes, NMEA or UBX, as gnss_driver would understand them on
/// its port; map lies at `origin`. Throws RecordingError where it cannot be read.
ReceiverRecording ReadReceiver(const std::string& file, const GnssDriverParams& driver,
                               const GeodeticPoint& origin);

/// GNSS of a run, whose driver had its origin at `from`, in the map that lies at `to`.
std::vector<gnss_t> InMap(std::vector<gnss_t> fixes, const GeodeticPoint& from,
                          const GeodeticPoint& to);

/// Without the fixes that lie more than kMaxTruthGap outside of the log's time: a receiver records
/// for longer than the car does.
std::vector<gnss_t> DuringLog(const std::vector<gnss_t>& fixes, const RunLog& log);

/// Copies the log `from` to `to`, with TRUTH_TRACK before all and each TRUTH where its time lies on
/// the log's clock. All other events stay as they are, in their order; TRUTH and TRUTH_TRACK that
/// `from` holds are left out. Throws std::runtime_error where it cannot.
void WriteTruthLog(const std::string& from, const std::string& to, const Track& track,
                   const std::vector<truth_t>& truth);

}  // namespace hairpin
