#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/simulator/track_testing.hpp"
#include "tools/simulator/track_formats.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {
namespace {

LoadedTrack Reread(const std::string& text, const std::string& name) {
  const TemporaryFolder folder;
  std::ofstream(folder.File(name)) << text;
  return LoadTrackOfAnyFormat(folder.File(name));
}

TEST(TrackExport, ToPacsimAndEufsIsReadBackAsTheSameTrack) {
  const Track own = LoadTrack(Fixture("oval_hairpin.yaml"));
  for (const LoadedTrack& loaded :
       {Reread(ToPacsim(own), "a.yaml"), Reread(ToEufs(own), "a.csv")}) {
    SCOPED_TRACE(NameOf(loaded.format));
    EXPECT_EQ(PositionsOf(loaded.track.left), PositionsOf(own.left));
    EXPECT_EQ(PositionsOf(loaded.track.right), PositionsOf(own.right));
    EXPECT_EQ(loaded.track.others.size(), own.others.size());
    EXPECT_LT((loaded.track.start_line.left - own.start_line.left).norm(), 1e-3);
    EXPECT_NEAR(loaded.track.start.yaw, own.start.yaw, 1e-4);
  }
}

TEST(TrackExport, OfASavedMapIsATrack) {
  const Track own = LoadTrack(Fixture("oval_hairpin.yaml"));
  std::string map =
      "hairpin_map: 1\nsession: 1\nutime: 1\nlaps: 1\nstart: [0.0, 0.0, 0.0]\n"
      "finish_line_m: [[6.0, 2.0], [6.0, -2.0]]\ncones:\n";
  for (const auto* side : {&own.right, &own.left}) {
    for (const TrackCone& cone : *side) {
      map += "  - {id: 1, position_m: [" + std::to_string(cone.position.x()) + ", " +
             std::to_string(cone.position.y()) + "], colour: " + std::string(NameOf(cone.colour)) +
             "}\n";
    }
  }
  const LoadedTrack loaded = Reread(map, "map.yaml");
  EXPECT_EQ(loaded.format, TrackFormat::kMap);
  EXPECT_EQ(loaded.track.left.size(), own.left.size());
  EXPECT_EQ(loaded.track.right.size(), own.right.size());
  EXPECT_LT((loaded.track.start_line.left - own.start_line.left).norm(), 1e-6);
}

}  // namespace
}  // namespace hairpin
