// The wire contract of the car, pinned. A change of any field's name, type or order in lcmtypes/
// fails here: every log recorded before becomes unreadable, and no daemon built before understands
// one built after. To update after an intended change: run this test, copy the line that it prints
// for the type into the table, and let the commit that changes the .lcm file carry the change of
// the table.

#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "common/channels.hpp"
#include "hairpin/boundary_point_t.hpp"
#include "hairpin/channel_health_t.hpp"
#include "hairpin/cone_cluster_t.hpp"
#include "hairpin/cone_observation_t.hpp"
#include "hairpin/global_cone_t.hpp"
#include "hairpin/local_cone_t.hpp"
#include "hairpin/path_point_t.hpp"
#include "hairpin/path_score_t.hpp"
#include "hairpin/race_line_point_t.hpp"
#include "hairpin/truth_cone_t.hpp"
#include "hairpin/view_sector_t.hpp"

namespace hairpin {
namespace {

const std::map<std::string, uint64_t> kPinned{
    {"as_state_t", 0x64fafff1108dacfbu},       {"boundary_point_t", 0x9cd264b380acf4eau},
    {"channel_health_t", 0xe39580229d3ac0b7u}, {"cone_observation_t", 0x141d076b77a0fd60u},
    {"cones_t", 0x59ee8319ec28bb25u},          {"drive_command_t", 0x5965b3fa62afb67au},
    {"gnss_t", 0x3dda50c87caf4211u},           {"ground_speed_t", 0x5d303aa661d6d42au},
    {"heartbeat_t", 0xef1cb64026dd901bu},      {"imu_t", 0xe776272a8131cc99u},
    {"local_cone_t", 0x5d0f76783e214674u},     {"local_map_t", 0xb974666942e65de7u},
    {"motors_t", 0x308757d107388184u},         {"path_point_t", 0x1a2439e3b3eed9ffu},
    {"path_score_t", 0x13ce81826380f387u},     {"pipeline_status_t", 0x6dbf414a6045ca8fu},
    {"steering_t", 0xc8d85ba29519e76fu},       {"track_t", 0x9a8ce285ab59ae6au},
    {"truth_cone_t", 0x0c8e829833420196u},     {"truth_t", 0x9a8ca8f0e7d0b94au},
    {"truth_track_t", 0x78473a999abfb991u},    {"vehicle_t", 0xe977650b576cbf58u},
    {"cone_cluster_t", 0x184e7bec69fd5cd0u},   {"cone_clusters_t", 0x519f077439ef7890u},
    {"global_cone_t", 0x62c355997fc0bcc1u},    {"global_map_t", 0x49d41c80ac4b5c77u},
    {"lidar_scan_t", 0xf35992f7689b9cd4u},     {"race_line_point_t", 0x7ad0da9c37111ec2u},
    {"race_line_t", 0xac1594ee0aaa1394u},      {"velocity_t", 0x7a904c2206ae3cb8u},
    {"view_sector_t", 0x4e3168e5e1b7cf57u},
};

template <class... Messages>
std::map<std::string, uint64_t> Fingerprints() {
  return {{Messages::getTypeName(), static_cast<uint64_t>(Messages::getHash())}...};
}

std::map<std::string, uint64_t> AllFingerprints() {
  return Fingerprints<as_state_t, boundary_point_t, channel_health_t, cone_cluster_t,
                      cone_clusters_t, cone_observation_t, cones_t, drive_command_t, global_cone_t,
                      global_map_t, gnss_t, ground_speed_t, heartbeat_t, imu_t, lidar_scan_t,
                      local_cone_t, local_map_t, motors_t, path_point_t, path_score_t,
                      pipeline_status_t, race_line_point_t, race_line_t, steering_t, track_t,
                      truth_cone_t, truth_t, truth_track_t, vehicle_t, velocity_t, view_sector_t>();
}

TEST(Fingerprints, OfEveryTypeAreAsPinned) {
  for (const auto& [type, fingerprint] : AllFingerprints()) {
    const auto pinned = kPinned.find(type);
    if (pinned != kPinned.end() && pinned->second == fingerprint) continue;
    char line[128];
    std::snprintf(line, sizeof line, "{\"%s\", 0x%016" PRIx64 "u},", type.c_str(), fingerprint);
    ADD_FAILURE() << line;
  }
}

TEST(Fingerprints, ArePinnedForEveryDefinitionThereIs) {
  std::set<std::string> defined;
  for (const auto& entry : std::filesystem::directory_iterator(HAIRPIN_SOURCE_DIR "/lcmtypes")) {
    if (entry.path().extension() == ".lcm") defined.insert(entry.path().stem());
  }
  std::set<std::string> pinned;
  for (const auto& [type, fingerprint] : kPinned) pinned.insert(type);
  EXPECT_EQ(pinned, defined);
}

TEST(Fingerprints, DifferBetweenTypes) {
  std::set<uint64_t> seen;
  for (const auto& [type, fingerprint] : AllFingerprints())
    EXPECT_TRUE(seen.insert(fingerprint).second) << type;
}

}  // namespace
}  // namespace hairpin
