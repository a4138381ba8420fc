// The Debian package, installed into a container that systemd boots: what the car's own computer
// does at its start.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/process.hpp"
#include "tests/support/race_run.hpp"

namespace hairpin {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = HAIRPIN_SOURCE_DIR;
const fs::path kBinary = HAIRPIN_BINARY_DIR;
constexpr int kPatienceMs = 300'000;

bool CanBoot() {
  return geteuid() == 0 && Process({"sh", "-c",
                                    "command -v systemd-nspawn && unshare --mount true && "
                                    "grep -qw overlay /proc/filesystems"})
                                   .Wait(10'000) == 0;
}

// The package just built from what is here.
fs::path Package() {
  for (const auto& entry : fs::directory_iterator(kBinary)) {
    if (entry.path().extension() == ".deb") return entry.path();
  }
  return {};
}

TEST(InstalledPackage, KeepsTheCarRunningUnderSystemd) {
  if (!CanBoot()) GTEST_SKIP() << "needs root, systemd-nspawn and overlay mounts";
  Process package({kSource / "tools/package"});
  ASSERT_EQ(package.Wait(kPatienceMs), 0) << package.Output();

  const TemporaryFolder folder;
  fs::copy_file(Package(), folder.File("hairpin.deb"));
  fs::copy_file(kBinary / "bin/hairpin-race", folder.File("hairpin-race"));
  fs::copy(kSource / "config", folder.File("config"), fs::copy_options::recursive);
  fs::copy_file(kSource / "tests/system/race/installed_check.sh", folder.File("check.sh"));
  Process container({kSource / "tests/support/container.sh",
                     fs::path(folder.File(".")).parent_path(), "check.sh"});
  const std::optional<int> code = container.Wait(kPatienceMs);
  ASSERT_TRUE(code) << "still running";

  std::ifstream output(folder.File("output"));
  int passed = 0;
  std::ostringstream all;
  for (std::string line; std::getline(output, line);) {
    if (line.starts_with("ok ")) ++passed;
    if (line.starts_with("FAILED ")) ADD_FAILURE() << line;
    all << line << '\n';
  }
  EXPECT_EQ(*code, 0) << all.str();
  EXPECT_GE(passed, 25) << all.str();
  std::cout << all.str();
}

}  // namespace
}  // namespace hairpin
