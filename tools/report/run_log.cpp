#include "tools/report/run_log.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>

#include "common/wire_schema.hpp"
#include "tools/report/log_reader.hpp"

namespace hairpin {
namespace {

/// Empty unless the bytes are exactly one message of type M, with every length checked before
/// anything is allocated.
template <class M>
std::optional<M> Decode(const std::vector<uint8_t>& bytes) {
  constexpr size_t kFingerprint = sizeof(int64_t);
  if (bytes.size() < kFingerprint) return std::nullopt;
  uint64_t fingerprint = 0;
  for (size_t i = 0; i < kFingerprint; ++i) fingerprint = fingerprint << 8 | bytes[i];
  if (fingerprint != static_cast<uint64_t>(M::getHash())) return std::nullopt;
  const size_t size = bytes.size() - kFingerprint;
  if (!WireSchema::Hairpin().Problem(M::getTypeName(), bytes.data() + kFingerprint, size).empty())
    return std::nullopt;
  M message{};
  if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) !=
      static_cast<int>(bytes.size()))
    return std::nullopt;
  return message;
}

using Take = std::function<bool(const std::vector<uint8_t>&)>;  // false: undecodable

template <class M>
Take Into(std::vector<M>& messages) {
  return [&messages](const std::vector<uint8_t>& bytes) {
    auto message = Decode<M>(bytes);
    if (message) messages.push_back(std::move(*message));
    return message.has_value();
  };
}

template <class M>
Take IntoFirst(std::optional<M>& first) {
  return [&first](const std::vector<uint8_t>& bytes) {
    auto message = Decode<M>(bytes);
    if (message && !first) first = std::move(*message);
    return message.has_value();
  };
}

template <class M>
void SortByTime(std::vector<M>& messages) {
  const auto key = [](const M& m) { return std::tuple(m.utime, m.boot_id, m.sequence); };
  std::stable_sort(messages.begin(), messages.end(),
                   [key](const M& a, const M& b) { return key(a) < key(b); });
  const auto same = [key](const M& a, const M& b) { return key(a) == key(b); };
  messages.erase(std::unique(messages.begin(), messages.end(), same), messages.end());
}

std::map<std::string, Take> Takers(RunLog& log) {
  return {{channels::kTruth.name, Into(log.truth)},
          {channels::kTruthTrack.name, IntoFirst(log.truth_track)},
          {channels::kLocalMap.name, Into(log.local_maps)},
          {channels::kGlobalMap.name, Into(log.global_maps)},
          {channels::kTrack.name, Into(log.tracks)},
          {channels::kPipelineStatus.name, Into(log.pipeline_status)},
          {channels::kAsState.name, Into(log.as_states)},
          {channels::kRaceLine.name, Into(log.race_lines)},
          {channels::kDriveCommand.name, Into(log.drive_commands)},
          {channels::kVelocity.name, Into(log.velocities)},
          {channels::kGnss.name, Into(log.gnss)},
          {channels::kConesFusion.name, Into(log.cones_fusion)},
          {channels::kConesLidar.name, Into(log.cones_lidar)},
          {channels::kConesCamera.name, Into(log.cones_camera)}};
}

void SortAll(RunLog& log) {
  SortByTime(log.truth);
  SortByTime(log.local_maps);
  SortByTime(log.global_maps);
  SortByTime(log.tracks);
  SortByTime(log.pipeline_status);
  SortByTime(log.as_states);
  SortByTime(log.race_lines);
  SortByTime(log.drive_commands);
  SortByTime(log.velocities);
  SortByTime(log.gnss);
  SortByTime(log.cones_fusion);
  SortByTime(log.cones_lidar);
  SortByTime(log.cones_camera);
}

}  // namespace

RunLog LoadRunLog(const std::string& path, int64_t max_bytes) {
  RunLog log;
  const auto takers = Takers(log);
  LogReader reader(path);
  int64_t kept_bytes = 0;
  while (const auto event = reader.Next()) {
    const int64_t time = event->timestamp_us;
    log.first_us = log.events == 0 ? time : std::min(log.first_us, time);
    log.last_us = log.events == 0 ? time : std::max(log.last_us, time);
    ++log.events;
    const auto taker = takers.find(event->channel);
    if (taker == takers.end()) continue;
    const auto size = static_cast<int64_t>(event->data.size());
    if (kept_bytes + size > max_bytes) {
      ++log.over_limit;
    } else if (taker->second(event->data)) {
      kept_bytes += size;
    } else {
      ++log.undecodable;
    }
  }
  log.skipped_bytes = reader.skipped_bytes();
  SortAll(log);
  return log;
}

}  // namespace hairpin
