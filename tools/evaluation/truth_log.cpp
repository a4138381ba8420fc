#include "tools/evaluation/truth_log.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "common/channels.hpp"
#include "common/clock.hpp"
#include "tools/evaluation/recording_error.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/log_writer.hpp"
#include "tools/report/trajectory.hpp"
#include "tools/simulator/truth.hpp"

namespace hairpin {
namespace {

constexpr size_t kChunk = size_t{1} << 16;
constexpr int64_t kBootId = 1;  // there is no other sender of these channels

bool IsTruth(const std::string& channel) {
  return channel == channels::kTruth.name || channel == channels::kTruthTrack.name;
}

}  // namespace

ReceiverRecording ReadReceiver(const std::string& file, const GnssDriverParams& driver,
                               const GeodeticPoint& origin) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw RecordingError(file + ": cannot be read");
  const LocalEnu plane(origin);
  GnssDecoder decoder(driver.errors);
  ReceiverRecording recording;
  const auto take = [&](const GnssFix& fix) {
    recording.fixes.push_back(ToMessage(fix, &plane, driver.antenna_baseline_yaw));
  };
  std::vector<uint8_t> chunk(kChunk);
  while (stream) {
    stream.read(reinterpret_cast<char*>(chunk.data()), static_cast<std::streamsize>(chunk.size()));
    const Bytes bytes = Bytes(chunk).first(static_cast<size_t>(stream.gcount()));
    for (const GnssFix& fix : decoder.Add(bytes)) take(fix);
  }
  if (const std::optional<GnssFix> last = decoder.Flush()) take(*last);
  recording.bad_frames = decoder.bad();
  return recording;
}

std::vector<gnss_t> InMap(std::vector<gnss_t> fixes, const GeodeticPoint& from,
                          const GeodeticPoint& to) {
  const LocalEnu driver(from);
  const LocalEnu map(to);
  for (gnss_t& fix : fixes) {
    double* enu = fix.position_enu_m;
    const Eigen::Vector3d position = map.ToEnu(driver.ToGeodetic({enu[0], enu[1], enu[2]}));
    std::copy(position.begin(), position.end(), enu);
  }
  return fixes;
}

std::vector<gnss_t> DuringLog(const std::vector<gnss_t>& fixes, const RunLog& log) {
  const int64_t begin = AddSeconds(log.first_us, -kMaxTruthGap);
  const int64_t end = AddSeconds(log.last_us, kMaxTruthGap);
  std::vector<gnss_t> during;
  std::copy_if(fixes.begin(), fixes.end(), std::back_inserter(during),
               [&](const gnss_t& fix) { return fix.utime >= begin && fix.utime <= end; });
  return during;
}

void WriteTruthLog(const std::string& from, const std::string& to, const Track& track,
                   const std::vector<truth_t>& truth) {
  LogReader reader(from);
  LogWriter writer(to);
  int32_t sequence = 0;
  auto next = truth.begin();
  const auto write_truth = [&](const truth_t& pose) {
    truth_t message = pose;
    message.boot_id = kBootId;
    message.sequence = sequence++;
    writer.Write(message.utime, channels::kTruth, message);
  };
  bool is_first = true;
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (IsTruth(event->channel)) continue;
    if (std::exchange(is_first, false)) {
      truth_track_t message = TruthTrackMessage(track, event->timestamp_us, 0);
      message.boot_id = kBootId;
      writer.Write(event->timestamp_us, channels::kTruthTrack, message);
    }
    for (; next != truth.end() && next->utime <= event->timestamp_us; ++next) write_truth(*next);
    writer.Write(event->timestamp_us, event->channel, event->data.data(), event->data.size());
  }
  std::for_each(next, truth.end(), write_truth);
  writer.Close();
}

}  // namespace hairpin
