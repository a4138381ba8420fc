#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tools/simulator/track.hpp"
#include "tools/simulator/track_geometry.hpp"

namespace hairpin {

inline std::string Fixture(const std::string& name) {
  return std::string(HAIRPIN_SOURCE_DIR) + "/tests/fixtures/tracks/" + name;
}

inline std::string TextOf(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A file of this test alone, removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& extension) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name() + extension;
    for (char& c : name) {
      if (c == '/') c = '_';
    }
    path_ = (std::filesystem::temp_directory_path() / name).string();
  }
  TemporaryFile(const std::string& extension, const std::string& text) : TemporaryFile(extension) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// `text` with the first `from` replaced; fails the test where there is none.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Number of the line on which the first `what` stands.
inline int LineOf(const std::string& text, const std::string& what) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// The reason for which `text` is refused, behind "file:"; empty where it is not.
inline std::string RefusalOf(const std::string& text, const std::string& extension = ".yaml") {
  const TemporaryFile file(extension, text);
  try {
    LoadTrack(file.path());
  } catch (const TrackError& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with(file.path() + ":")) << what;
    return what.substr(std::min(what.size(), file.path().size() + 1));
  }
  return "";
}

inline void ExpectEqual(const Track& a, const Track& b) {
  const auto expect_cones = [](const std::vector<TrackCone>& x, const std::vector<TrackCone>& y) {
    ASSERT_EQ(x.size(), y.size());
    for (size_t i = 0; i < x.size(); ++i) {
      EXPECT_EQ(x[i].position, y[i].position) << i;
      EXPECT_EQ(x[i].colour, y[i].colour) << i;
    }
  };
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.closed, b.closed);
  EXPECT_EQ(a.start.position(), b.start.position());
  EXPECT_EQ(a.start.yaw, b.start.yaw);
  EXPECT_EQ(a.start_line.left, b.start_line.left);
  EXPECT_EQ(a.start_line.right, b.start_line.right);
  EXPECT_EQ(a.finish_line.left, b.finish_line.left);
  EXPECT_EQ(a.finish_line.right, b.finish_line.right);
  expect_cones(a.left, b.left);
  expect_cones(a.right, b.right);
  expect_cones(a.others, b.others);
  EXPECT_EQ(a.clutter, b.clutter);
}

/// Each side begins ahead of the waiting car within one gap of the start line, and leads on from
/// there.
inline void ExpectSidesBeginAtTheLine(const Track& track) {
  const Pose2 T_base_map = track.start.Inverse();
  const Eigen::Vector2d heading = track.start.rotation().col(0);
  for (const bool is_left : {true, false}) {
    const auto& side = is_left ? track.left : track.right;
    const Eigen::Vector2d& end = is_left ? track.start_line.left : track.start_line.right;
    EXPECT_LT((side[0].position - end).norm(), 10.0);
    EXPECT_GE((side[0].position - end).dot(heading), -0.5);
    EXPECT_GT((side[1].position - side[0].position).dot(heading), 0.0);
    EXPECT_EQ((T_base_map * side[0].position).y() > 0.0, is_left);
    if (track.closed) {
      EXPECT_LE((side.back().position - end).dot(heading), 0.5);
    }
  }
}

}  // namespace hairpin
