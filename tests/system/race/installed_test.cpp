// The Debian package on a machine that systemd boots, a container or user-mode-linux: what the
// car's own computer does at its start.
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

// What runs in the guest and what it needs, as /mnt there.
void Fill(const TemporaryFolder& folder, const std::string& script) {
  fs::copy_file(kBinary / "bin/hairpin-race", folder.File("hairpin-race"));
  fs::copy(kSource / "config", folder.File("config"), fs::copy_options::recursive);
  fs::copy_file(kSource / "tests/support/checks.sh", folder.File("checks.sh"));
  fs::copy_file(kSource / "tests/system/race" / script, folder.File("check.sh"));
}

// Boots it, and fails for each check that did.
void ExpectChecks(const TemporaryFolder& folder, const char* guest, int patience_ms, int checks) {
  Process boot(
      {kSource / "tests/support" / guest, fs::path(folder.File(".")).parent_path(), "check.sh"});
  const std::optional<int> code = boot.Wait(patience_ms);
  std::ifstream output(folder.File("output"));
  int passed = 0;
  std::ostringstream all;
  for (std::string line; std::getline(output, line);) {
    if (line.starts_with("ok ")) ++passed;
    if (line.starts_with("FAILED ")) ADD_FAILURE() << line;
    all << line << '\n';
  }
  ASSERT_TRUE(code) << "still running\n" << all.str();
  EXPECT_EQ(*code, 0) << all.str();
  EXPECT_GE(passed, checks) << all.str();
  std::cout << all.str();
}

void BuildPackage() {
  Process package({kSource / "tools/package"});
  ASSERT_EQ(package.Wait(kPatienceMs), 0) << package.Output();
}

TEST(InstalledPackage, KeepsTheCarRunningUnderSystemd) {
  if (!CanBoot()) GTEST_SKIP() << "needs root, systemd-nspawn and overlay mounts";
  BuildPackage();
  const TemporaryFolder folder;
  fs::copy_file(Package(), folder.File("hairpin.deb"));
  Fill(folder, "installed_check.sh");
  ExpectChecks(folder, "container.sh", kPatienceMs, 27);
}

// The package's files over the guest's root, with what such a slow machine needs otherwise.
void PrepareSlowMachine(const fs::path& root) {
  Process unpack({"dpkg-deb", "-x", Package(), root});
  ASSERT_EQ(unpack.Wait(kPatienceMs), 0) << unpack.Output();
  const fs::path units = root / "etc/systemd/system";
  fs::create_directories(units / "hairpin-.service.d");
  // With the address lists LCM hears nothing there; and real-time priority on its one processor
  // leaves none to systemd itself.
  std::ofstream(units / "hairpin-.service.d/90-slow.conf")
      << "[Service]\nWatchdogSec=120\nTimeoutStartSec=600\nIPAddressDeny=\nIPAddressAllow=\n"
         "CPUSchedulingPolicy=other\nNice=5\n";
  // Cones come from the simulator: their own drivers, and the log, would only cost time.
  for (const char* unit :
       {"logger", "gnss_driver", "lidar_cone_detector", "lidar_driver@front", "lidar_driver@top"})
    fs::create_symlink("/dev/null", units / (std::string("hairpin-") + unit + ".service"));
  // All other times of the gateway are the car's, which the frames carry. No log is written, and
  // the disk is memory.
  const fs::path config = root / "etc/hairpin";
  Process slow({"sed", "-i",
                "s/^\\( *bus_silence_s:\\).*/\\1 1.0/; s/^\\(min_free_disk_gb:\\).*/\\1 0.1/; "
                "s|^\\(log_folder:\\).*|\\1 /var/lib/hairpin|",
                config / "can_gateway.yaml", config / "mission_manager.yaml"});
  ASSERT_EQ(slow.Wait(kPatienceMs), 0) << slow.Output();
}

// Takes many minutes, so it is asked for by hand: see tests/system/race/README.md.
TEST(DISABLED_UserModeLinux, DrivesALapOverTheKernelsCanWithDaemonsThatSystemdStarted) {
  if (geteuid() != 0 || !fs::exists("/usr/bin/linux.uml"))
    GTEST_SKIP() << "needs root and user-mode-linux";
  BuildPackage();
  const TemporaryFolder folder;
  PrepareSlowMachine(folder.File("files"));
  Fill(folder, "uml_check.sh");
  std::ofstream(folder.File("track")) << "default\n";
  constexpr int kLongPatienceMs = 3'600'000;
  ExpectChecks(folder, "uml.sh", kLongPatienceMs, 18);
}

}  // namespace
}  // namespace hairpin
