#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemons/global_mapper/map_record.hpp"

namespace hairpin {

/// A record as bytes, little-endian, and back. Decoding checks every length before it allocates;
/// empty where the bytes are no record, have some left over, or hold a number that is not finite.
std::vector<uint8_t> Encode(const MapRecord& record);
std::optional<MapRecord> DecodeMapRecord(std::span<const uint8_t> bytes);

}  // namespace hairpin
