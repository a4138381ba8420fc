// The daemon shell as the system sees it: a process with arguments, signals, exit codes, a notify
// socket and a network. The daemon is watchdog, the one that needs no other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>

#include "common/daemon.hpp"
#include "tests/support/own_network.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kDeadlineMs = 20'000;  // generous: the machine may be busy
const std::string kDaemon = HAIRPIN_BINARY_DIR "/bin/watchdog";
const std::string kConfig = HAIRPIN_SOURCE_DIR "/config";

std::vector<std::string> Command(const std::string& url, std::vector<std::string> more = {}) {
  std::vector<std::string> command{kDaemon, "--config-dir", kConfig, "--lcm-url", url};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

/// The receiving end of sd_notify.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : path_(path), socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    std::filesystem::remove(path);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const timeval deadline{kDeadlineMs / 1000, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &deadline, sizeof deadline);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot bind " + path);
    }
  }
  ~NotifySocket() {
    close(socket_);
    std::filesystem::remove(path_);
  }
  /// The next notification; "" when none came in time.
  std::string Next() const {
    char buffer[256];
    const ssize_t size = recv(socket_, buffer, sizeof buffer, 0);
    return size > 0 ? std::string(buffer, static_cast<size_t>(size)) : "";
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int socket_;
};

class DaemonProcess : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kDaemon)) GTEST_SKIP() << kDaemon << " is not built";
  }

  // Exit code and output of a run that must end by itself.
  std::pair<int, std::string> Run(const std::vector<std::string>& command) {
    Process process(command);
    const std::optional<int> code = process.Wait(kDeadlineMs);
    return {code.value_or(-1000), process.Output()};
  }

  TemporaryFolder folder_;
  std::string directory_ = folder_.path();
};

TEST_F(DaemonProcess, HelpsAndEndsWithZero) {
  const auto [code, output] = Run({kDaemon, "--help"});
  EXPECT_EQ(code, 0);
  EXPECT_THAT(output, AllOf(HasSubstr("--config-dir"), HasSubstr("--lcm-url"), HasSubstr("--set")));
}

TEST_F(DaemonProcess, RefusesWrongUsageWithTwo) {
  EXPECT_EQ(Run({kDaemon, "--no-such-option"}).first, kExitUsage);
  EXPECT_EQ(Run({kDaemon, "stray"}).first, kExitUsage);
  EXPECT_EQ(Run({kDaemon, "--lcm-url"}).first, kExitUsage);
}

TEST_F(DaemonProcess, RefusesBadConfigWith78AndEveryProblemOnItsOwnLine) {
  std::ifstream good(kConfig + "/watchdog.yaml");
  std::ofstream bad(directory_ + "/watchdog.yaml");
  for (std::string line; std::getline(good, line);) {
    if (line.starts_with("silence_s")) line = "silense_s: 0.5";
    if (line.starts_with("max_flaps")) line = "max_flaps: many";
    bad << line << '\n';
  }
  bad.close();
  const auto [code, output] = Run({kDaemon, "--config-dir", directory_, "--lcm-url", "memq://"});
  EXPECT_EQ(code, kExitConfig);
  EXPECT_THAT(output, AllOf(HasSubstr("max_flaps: `many` is no integer\n"),
                            HasSubstr("silence_s: is missing\n"),
                            HasSubstr("silense_s: unknown key (did you mean silence_s?)\n")));
  EXPECT_TRUE(output.starts_with("watchdog: "));
}

TEST_F(DaemonProcess, RefusesAMissingConfigAndAnUnknownOverrideWith78) {
  EXPECT_EQ(Run({kDaemon, "--config-dir", directory_, "--lcm-url", "memq://"}).first, kExitConfig);
  EXPECT_EQ(Run(Command("memq://", {"--set", "no_such_key=1"})).first, kExitConfig);
}

TEST_F(DaemonProcess, EndsWithOneWhereTheNetworkCannotBeOpened) {
  const auto [code, output] = Run(Command("nonsense://"));
  EXPECT_EQ(code, kExitFailure);
  EXPECT_THAT(output,
              AllOf(HasSubstr("watchdog: cannot open nonsense://"), HasSubstr("multicast route")));
}

TEST_F(DaemonProcess, TellsSystemdThatItIsReadyThenThatItWorksAndThatItStops) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const NotifySocket socket(directory_ + "/notify");
    Process daemon(Command("memq://"), {{"NOTIFY_SOCKET", socket.path()}});
    EXPECT_EQ(socket.Next(), "READY=1");
    for (int i = 0; i < 10; ++i)
      EXPECT_EQ(socket.Next(), "WATCHDOG=1") << "from the work loop, though nothing is heard";
    daemon.Signal(signal);
    EXPECT_EQ(daemon.Wait(kDeadlineMs), 0);
    std::string last;
    while (last == "" || last == "WATCHDOG=1") last = socket.Next();
    EXPECT_EQ(last, "STOPPING=1");
  }
}

/// A daemon and this test on one udpm network.
class DaemonOnUdpm : public DaemonProcess {
 protected:
  // Handles messages until `done`; false when that does not come to be in time. `idle` is called in
  // each pause.
  static bool WaitUntil(
      Transport& transport, const std::function<bool()>& done,
      const std::function<void()>& idle = [] {}) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(kDeadlineMs);
    while (!done()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      if (!transport.Handle(20)) idle();
    }
    return true;
  }
};

TEST_F(DaemonOnUdpm, SendsHeartbeatsInSilence) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  Transport transport(kDefaultLcmUrl);
  Bus bus(transport, "test", 1);
  std::vector<heartbeat_t> beats;
  bus.Subscribe(channels::kHeartbeat, [&](const heartbeat_t& beat) { beats.push_back(beat); });
  Process daemon(Command(kDefaultLcmUrl));
  ASSERT_TRUE(WaitUntil(transport, [&] { return beats.size() >= 5; }));
  EXPECT_EQ(beats.back().daemon, "watchdog");
  EXPECT_EQ(beats.back().build, BuildId());
  EXPECT_EQ(beats.back().types_hash, TypesHash());
  EXPECT_EQ(beats.back().utime, 0);
}

TEST_F(DaemonOnUdpm, SendsHeartbeatsWhileNothingButHeartbeatsIsHeard) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  Transport transport(kDefaultLcmUrl);
  Bus bus(transport, "test", 1);
  int beats = 0;
  bus.Subscribe(channels::kHeartbeat,
                [&](const heartbeat_t& beat) { beats += beat.daemon == "watchdog" ? 1 : 0; });
  Process daemon(Command(kDefaultLcmUrl));
  heartbeat_t mine{};
  mine.daemon = "test";
  EXPECT_TRUE(WaitUntil(
      transport, [&] { return beats >= 10; }, [&] { bus.Publish(channels::kHeartbeat, mine); }));
}

TEST_F(DaemonOnUdpm, AnnouncesAControlledStopInTotalSilence) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  Transport transport(kDefaultLcmUrl);
  Bus bus(transport, "test", 1);
  std::optional<pipeline_status_t> status;
  bus.Subscribe(channels::kPipelineStatus,
                [&](const pipeline_status_t& message) { status = message; });
  Process daemon(Command(kDefaultLcmUrl));
  ASSERT_TRUE(WaitUntil(transport, [&] { return status.has_value(); }));
  EXPECT_EQ(status->level, pipeline_status_t::LEVEL_CONTROLLED_STOP);
  EXPECT_EQ(status->map_mode, pipeline_status_t::MODE_NONE);
}

TEST_F(DaemonOnUdpm, CountsGarbageAndLivesOn) {
  if (!InOwnNetwork()) return RunInOwnNetwork();
  Transport transport(kDefaultLcmUrl);
  Bus bus(transport, "test", 1);
  int64_t undecodable = 0;
  bus.Subscribe(channels::kHeartbeat, [&](const heartbeat_t& beat) {
    for (const channel_health_t& health : beat.channels) {
      if (health.channel == "IMU") undecodable = health.undecodable;
    }
  });
  Process daemon(Command(kDefaultLcmUrl));
  const std::vector<uint8_t> garbage(200'000, 0xff);  // many fragments
  const auto send = [&] { transport.Publish("IMU", garbage.data(), garbage.size()); };
  EXPECT_TRUE(WaitUntil(
      transport, [&] { return undecodable >= 3; }, send));
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(kDeadlineMs), 0);
}

}  // namespace
}  // namespace hairpin
