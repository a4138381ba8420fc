#include "daemons/global_mapper/record_codec.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace hairpin {
namespace {

enum class Kind : int64_t { kKeyframe = 1, kMerge = 2, kRemoval = 3, kPlace = 4 };

constexpr int64_t kLoop = 1;  // bits of a merge
constexpr int64_t kByShape = 2;

static_assert(std::endian::native == std::endian::little, "records are little-endian");

class Writer {
 public:
  void Put(int64_t value) { Append(&value); }
  void Put(double value) { Append(&value); }
  void Put(const Pose2& pose) {
    for (const double value : {pose.x, pose.y, pose.yaw}) Put(value);
  }
  template <class Matrix>
  void PutAll(const Matrix& values) {
    for (const double value : values) Put(value);
  }
  std::vector<uint8_t> Take() { return std::move(bytes_); }

 private:
  template <class T>
  void Append(const T* value) {
    const auto* begin = reinterpret_cast<const uint8_t*>(value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
  }
  std::vector<uint8_t> bytes_;
};

/// Once something is wrong, everything reads as zero and `good()` is false.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  int64_t Integer() { return Take<int64_t>(); }
  double Number() {
    const auto value = Take<double>();
    good_ = good_ && std::isfinite(value);
    return good_ ? value : 0.0;
  }
  Pose2 Pose() {
    const double x = Number();
    const double y = Number();
    return {x, y, Number()};
  }
  template <class Values>
  void Fill(Values&& values) {
    for (double& value : values) value = Number();
  }
  /// Of things that take at least `size` bytes each.
  size_t Count(size_t size) {
    const int64_t count = Integer();
    good_ = good_ && count >= 0 && static_cast<uint64_t>(count) <= bytes_.size() / size;
    return good_ ? static_cast<size_t>(count) : 0;
  }
  bool good() const { return good_; }
  bool done() const { return good_ && bytes_.empty(); }

 private:
  template <class T>
  T Take() {
    T value{};
    good_ = good_ && bytes_.size() >= sizeof(T);
    if (!good_) return value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }
  std::span<const uint8_t> bytes_;
  bool good_ = true;
};

constexpr size_t kSightingBytes = size_t{8} * (4 + 2 + 4 + kNumConeColours);

void Put(const SightingRecord& sighting, Writer& writer) {
  writer.Put(sighting.landmark);
  writer.Put(sighting.local_id);
  writer.Put(int64_t{sighting.num_observations});
  writer.Put(int64_t{sighting.local_observations});
  writer.PutAll(sighting.position);
  writer.PutAll(sighting.covariance.reshaped());
  writer.PutAll(sighting.colour);
}

SightingRecord TakeSighting(Reader& reader) {
  SightingRecord sighting;
  sighting.landmark = reader.Integer();
  sighting.local_id = reader.Integer();
  sighting.num_observations = static_cast<int32_t>(reader.Integer());
  sighting.local_observations = static_cast<int32_t>(reader.Integer());
  reader.Fill(sighting.position);
  reader.Fill(sighting.covariance.reshaped());
  reader.Fill(sighting.colour);
  return sighting;
}

void Put(const KeyframeRecord& keyframe, Writer& writer) {
  writer.Put(static_cast<int64_t>(Kind::kKeyframe));
  writer.Put(keyframe.utime);
  writer.Put(keyframe.epoch);
  writer.Put(keyframe.T_local_base);
  writer.Put(keyframe.T_map_base);
  writer.Put(keyframe.T_before_base);
  writer.PutAll(keyframe.covariance.reshaped());
  writer.Put(static_cast<int64_t>(keyframe.sightings.size()));
  for (const SightingRecord& sighting : keyframe.sightings) Put(sighting, writer);
}

KeyframeRecord TakeKeyframe(Reader& reader) {
  KeyframeRecord keyframe;
  keyframe.utime = reader.Integer();
  keyframe.epoch = reader.Integer();
  keyframe.T_local_base = reader.Pose();
  keyframe.T_map_base = reader.Pose();
  keyframe.T_before_base = reader.Pose();
  reader.Fill(keyframe.covariance.reshaped());
  const size_t count = reader.Count(kSightingBytes);
  for (size_t i = 0; i < count; ++i) keyframe.sightings.push_back(TakeSighting(reader));
  return keyframe;
}

void Put(const MergeRecord& merge, Writer& writer) {
  writer.Put(static_cast<int64_t>(Kind::kMerge));
  writer.Put(merge.utime);
  writer.Put(int64_t{(merge.loop ? kLoop : 0) + (merge.by_shape ? kByShape : 0)});
  writer.Put(static_cast<int64_t>(merge.pairs.size()));
  for (const auto& [landmark, into] : merge.pairs) {
    writer.Put(landmark);
    writer.Put(into);
  }
}

MergeRecord TakeMerge(Reader& reader) {
  MergeRecord merge;
  merge.utime = reader.Integer();
  const int64_t how = reader.Integer();
  merge.loop = (how & kLoop) != 0;
  merge.by_shape = (how & kByShape) != 0;
  const size_t count = reader.Count(2 * sizeof(int64_t));
  for (size_t i = 0; i < count; ++i) {
    const int64_t landmark = reader.Integer();
    merge.pairs.emplace_back(landmark, reader.Integer());
  }
  return merge;
}

void Put(const PlaceRecord& place, Writer& writer) {
  writer.Put(static_cast<int64_t>(Kind::kPlace));
  writer.Put(place.utime);
  writer.Put(place.epoch);
  writer.Put(place.T_local_base);
  writer.Put(place.T_map_base);
  writer.PutAll(place.covariance.reshaped());
  writer.Put(place.laps);
  writer.Put(place.odometer);
  writer.Put(place.lap_odometer);
}

PlaceRecord TakePlace(Reader& reader) {
  PlaceRecord place;
  place.utime = reader.Integer();
  place.epoch = reader.Integer();
  place.T_local_base = reader.Pose();
  place.T_map_base = reader.Pose();
  reader.Fill(place.covariance.reshaped());
  place.laps = reader.Integer();
  place.odometer = reader.Number();
  place.lap_odometer = reader.Number();
  return place;
}

void Put(const RemovalRecord& removal, Writer& writer) {
  writer.Put(static_cast<int64_t>(Kind::kRemoval));
  writer.Put(removal.utime);
  writer.Put(static_cast<int64_t>(removal.landmarks.size()));
  for (const int64_t landmark : removal.landmarks) writer.Put(landmark);
}

RemovalRecord TakeRemoval(Reader& reader) {
  RemovalRecord removal;
  removal.utime = reader.Integer();
  const size_t count = reader.Count(sizeof(int64_t));
  for (size_t i = 0; i < count; ++i) removal.landmarks.push_back(reader.Integer());
  return removal;
}

}  // namespace

std::vector<uint8_t> Encode(const MapRecord& record) {
  Writer writer;
  std::visit([&](const auto& kind) { Put(kind, writer); }, record);
  return writer.Take();
}

std::optional<MapRecord> DecodeMapRecord(std::span<const uint8_t> bytes) {
  Reader reader(bytes);
  std::optional<MapRecord> record;
  switch (static_cast<Kind>(reader.Integer())) {
    case Kind::kKeyframe:
      record = TakeKeyframe(reader);
      break;
    case Kind::kMerge:
      record = TakeMerge(reader);
      break;
    case Kind::kRemoval:
      record = TakeRemoval(reader);
      break;
    case Kind::kPlace:
      record = TakePlace(reader);
      break;
  }
  if (!reader.done()) return std::nullopt;
  return record;
}

}  // namespace hairpin
