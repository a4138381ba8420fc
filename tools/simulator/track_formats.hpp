#pragma once

#include <string>
#include <string_view>

#include "tools/simulator/track.hpp"
#include "tools/simulator/track_yaml.hpp"

namespace hairpin {

enum class TrackFormat { kHairpin, kMap, kPacsim, kFssim, kEufs };

/// "hairpin YAML", "hairpin map", "PacSim YAML", "FSSIM YAML", "EUFS CSV".
std::string_view NameOf(TrackFormat format);

struct LoadedTrack {
  Track track;
  TrackFormat format = TrackFormat::kHairpin;
};

/// As LoadTrack(), and says which format it was.
LoadedTrack LoadTrackOfAnyFormat(const std::string& file);

/// Our own: key `hairpin_track`. Strict: a key too many is an error. Nothing is reordered.
Track ReadHairpinTrack(const TrackYaml& root);

/// A map that global_mapper saved: key `hairpin_map`. Its cones in any order, coloured by their
/// most probable class; always a lap. Cones of an unknown colour bound nothing.
Track ReadMapTrack(const TrackYaml& root);

/// PacSim: key `track`. Its start pose is the car's centre of gravity. `invisible` places shape a
/// side but are no cones; `unknown` lists things off the sides: objects without a colour are
/// clutter, coloured ones cones.
Track ReadPacsimTrack(const TrackYaml& root);

/// FSSIM: keys `cones_left` and others. Its start pose is the front wing's. Always a lap.
Track ReadFssimTrack(const TrackYaml& root);

/// EUFS: rows `tag,x,y,direction,...` in any order. `car_start` is the car's centre. Always a lap.
/// Cones of an unknown colour bound nothing.
Track ReadEufsTrack(const std::string& text, const std::string& file);

/// The track as another simulator's file. Clutter goes to PacSim's list `unknown`; EUFS has no
/// place for it, nor for a start line other than the large orange cones.
std::string ToPacsim(const Track& track);
std::string ToEufs(const Track& track);

}  // namespace hairpin
