#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

using testing::HasSubstr;

/// A checkout with one tracked file, and what the build makes of it.
class BuildIdTest : public testing::Test {
 protected:
  void SetUp() override {
    Git("init --quiet");
    Commit("one");
  }
  void Git(const std::string& command) const {
    const std::string identity = "git -c user.name=test -c user.email=test@localhost -C ";
    Shell(identity + checkout_.path() + " " + command);
  }
  std::string Hash() const {
    Git("rev-parse --short=12 HEAD > " + folder_.File("hash"));
    std::string hash;
    std::ifstream(folder_.File("hash")) >> hash;
    return hash;
  }
  void Write(const std::string& text) const { std::ofstream(checkout_.File("file")) << text; }
  void Commit(const std::string& text) const {
    Write(text);
    Git("add file");
    Git("commit --quiet --message=" + text);
  }
  std::string Build(const std::string& folder) const {
    Shell("cmake -DOUT=" + out_ + " -DDIR=" + folder +
          " -P " HAIRPIN_SOURCE_DIR "/common/build_id.cmake");
    std::ostringstream text;
    text << std::ifstream(out_).rdbuf();
    return text.str();
  }
  std::string Build() const { return Build(checkout_.path()); }

  TemporaryFolder checkout_, folder_;
  const std::string out_ = folder_.File("build_id.cpp");

 private:
  static void Shell(const std::string& command) {
    Process shell({"sh", "-c", command});
    ASSERT_EQ(shell.Wait(60'000), 0) << shell.Output();
  }
};

TEST_F(BuildIdTest, FollowsTheCheckoutFromBuildToBuild) {
  const std::string first = Hash();
  EXPECT_THAT(Build(), HasSubstr('"' + first + '"'));
  Write("other");
  EXPECT_THAT(Build(), HasSubstr('"' + first + "-dirty\""));
  Commit("two");
  ASSERT_NE(Hash(), first);
  EXPECT_THAT(Build(), HasSubstr('"' + Hash() + '"'));
}

TEST_F(BuildIdTest, LeavesItsFileAloneWhereNothingChanged) {
  Build();
  const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(out_, long_ago);
  const auto written = std::filesystem::last_write_time(out_);
  Build();
  EXPECT_EQ(std::filesystem::last_write_time(out_), written);
}

TEST_F(BuildIdTest, IsUnknownOutsideACheckout) {
  EXPECT_THAT(Build(folder_.path()), HasSubstr("\"unknown\""));
}

}  // namespace
}  // namespace hairpin
