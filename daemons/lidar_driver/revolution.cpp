#include "daemons/lidar_driver/revolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "common/clock.hpp"

namespace hairpin {
namespace {

constexpr int kFullTurn = 36000;  // 0.01 deg
constexpr double kRadiansPerHundredth = std::numbers::pi / 18000.0;
// The message's ages reach 0.26 s; the slowest head takes 0.2 s for a turn.
constexpr double kMaxDuration = 0.25;  // s
// The head's position jitters by a few hundredths from packet to packet; this is no new turn.
constexpr int kMaxJitter = 100;

int Phase(int azimuth, int cut) { return (azimuth - cut + kFullTurn) % kFullTurn; }

}  // namespace

RevolutionAssembler::RevolutionAssembler(const RevolutionParams& params, double column_period)
    : max_refused_share_(params.max_refused_share), column_period_(column_period) {
  if (!std::isfinite(params.cut_azimuth))
    throw std::invalid_argument("RevolutionAssembler: cut_azimuth must be finite");
  if (!(max_refused_share_ >= 0.0 && max_refused_share_ <= 1.0))
    throw std::invalid_argument("RevolutionAssembler: max_refused_share must be 0 to 1");
  const double turns = params.cut_azimuth / (2.0 * std::numbers::pi);
  cut_ = static_cast<int>(std::lround((turns - std::floor(turns)) * kFullTurn)) % kFullTurn;
}

bool RevolutionAssembler::Advances(const DecodedPacket& packet) const {
  const int first = packet.columns.front().azimuth;
  return first != packet.columns.back().azimuth && first != last_azimuth_;
}

std::optional<Revolution> RevolutionAssembler::Add(const DecodedPacket& packet, int64_t utime) {
  last_azimuth_ = packet.columns.front().azimuth;
  const double turned = SecondsBetween(current_.utime, utime) / column_period_ * packet.column_turn;
  if (last_phase_ && turned >= kFullTurn) Reset();  // nothing was heard for a turn
  std::optional<Revolution> complete;
  size_t first = 0;
  for (size_t i = 0; i < packet.columns.size(); ++i) {
    const int phase = Phase(packet.columns[i].azimuth, cut_);
    if (last_phase_ && phase + kMaxJitter < *last_phase_) {
      AddColumns(packet, first, i, utime);
      first = i;
      if (auto revolution = Complete()) complete = std::move(revolution);
      begin_utime_ = AddSeconds(utime, static_cast<double>(packet.columns[i].time));
      from_its_beginning_ = true;
    }
    last_phase_ = phase;
  }
  AddColumns(packet, first, packet.columns.size(), utime);
  if (from_its_beginning_ && SecondsBetween(begin_utime_, current_.utime) > kMaxDuration) {
    ++given_up_;
    Reset();
  }
  return complete;
}

// Ages count, until the revolution is complete, from its beginning on.
void RevolutionAssembler::AddColumns(const DecodedPacket& packet, size_t first, size_t last,
                                     int64_t utime) {
  if (first == last) return;
  const double end = static_cast<double>(packet.columns[last - 1].time) + column_period_;
  current_.utime = AddSeconds(utime, std::min(end, packet.duration));
  if (!from_its_beginning_) return;
  covered_ += static_cast<double>(last - first) * packet.column_turn;
  columns_ += static_cast<int64_t>(last - first);
  ++current_.packets;
  const size_t begin_point = first == 0 ? 0 : packet.columns[first - 1].end;
  const size_t end_point = packet.columns[last - 1].end;
  const auto since_begin = static_cast<float>(SecondsBetween(begin_utime_, utime));
  const auto begin = packet.points.begin() + static_cast<std::ptrdiff_t>(begin_point);
  const size_t before = current_.points.size();
  current_.points.insert(current_.points.end(), begin,
                         packet.points.begin() + static_cast<std::ptrdiff_t>(end_point));
  for (size_t i = before; i < current_.points.size(); ++i) current_.points[i].age += since_begin;
}

std::optional<Revolution> RevolutionAssembler::Complete() {
  Revolution revolution = std::exchange(current_, {});
  current_.points.reserve(revolution.points.capacity());
  const double covered = std::exchange(covered_, 0.0);
  const auto columns = static_cast<double>(std::exchange(columns_, 0));
  if (!from_its_beginning_ || revolution.packets == 0) return std::nullopt;
  const auto all = static_cast<double>(revolution.packets + revolution.refused);
  const double duration = SecondsBetween(begin_utime_, revolution.utime);
  if (static_cast<double>(revolution.refused) > max_refused_share_ * all ||
      duration > kMaxDuration) {
    ++given_up_;
    return std::nullopt;
  }
  revolution.covered_share = std::min(1.0, covered / kFullTurn);
  revolution.column_step = covered / columns * kRadiansPerHundredth;
  const auto whole = static_cast<float>(duration);
  for (LidarPoint& point : revolution.points) point.age = std::max(0.0f, whole - point.age);
  return revolution;
}

void RevolutionAssembler::Reset() {
  const int64_t refused = current_.refused;
  current_ = {};
  current_.refused = refused;
  covered_ = 0.0;
  columns_ = 0;
  from_its_beginning_ = false;
  last_phase_.reset();
}

}  // namespace hairpin
