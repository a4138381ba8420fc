#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "tools/race/overrides.hpp"
#include "tools/race/packet_sender.hpp"
#include "tools/race/stack.hpp"
#include "tools/simulator/pseudo_terminal.hpp"

namespace hairpin {
namespace {

constexpr int64_t kRestartDelay = 100'000;      // us
constexpr int64_t kRestartWindow = 10'000'000;  // us
constexpr size_t kMaxRestarts = 5;              // in the window
constexpr int kTailLines = 8;
// The sensors' own addresses are not this machine's: their packets come from loopback.
const char* const kLoopbackSensors[] = {"front.sensor_address=127.0.0.1",
                                        "top.sensor_address=127.0.0.1"};

// Runs in the child: exec replaces it, or it exits.
[[noreturn]] void Exec(const std::vector<std::string>& words, const std::string& log_file) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // whatever happens to us, no daemon stays behind
  const int log = open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log >= 0) dup2(log, STDERR_FILENO);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  const std::string problem = words[0] + ": " + std::strerror(errno) + "\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, problem.data(), problem.size());
  _exit(kExitConfig);
}

std::string Tail(const std::string& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::string tail;
  const size_t first = lines.size() > kTailLines ? lines.size() - kTailLines : 0;
  for (size_t i = first; i < lines.size(); ++i) tail += "\n  " + lines[i];
  return tail;
}

}  // namespace

void AttachedStack::SetDaemon(const std::string& name, bool) {
  throw std::logic_error(name + " was started by another");
}

ProcessStack::ProcessStack(const StackOptions& options, const std::string& lcm_url)
    : options_(options), lcm_url_(lcm_url) {
  if (options.level == SensorLevel::kRaw) {
    const std::string program = "lidar_driver";
    sender_ = std::make_unique<PacketSender>(
        Config::Load(options.config_dir, program, OverridesOf(program, options.overrides)));
    gnss_port_ = std::make_unique<PseudoTerminal>();
    options_.overrides.push_back("gnss_driver.port=" + gnss_port_->path());
  }
  for (const std::string& name : DaemonsOf(options)) Start(name, processes_[name]);
}

ProcessStack::~ProcessStack() {
  for (auto& [name, process] : processes_) {
    if (process.pid > 0) kill(process.pid, SIGTERM);
  }
  for (auto& [name, process] : processes_) {
    if (process.pid > 0) waitpid(process.pid, nullptr, 0);
  }
}

void ProcessStack::Start(const std::string& name, Process& process) {
  const DaemonProgram daemon = ProgramOf(name);
  std::vector<std::string> words{options_.program_dir + "/" + daemon.program, "--config-dir",
                                 options_.config_dir, "--lcm-url", lcm_url_};
  std::vector<std::string> overrides = OverridesOf(daemon.program, options_.overrides);
  if (!daemon.instance.empty()) {
    words.push_back("--instance");
    words.push_back(daemon.instance);
    overrides.insert(overrides.end(), std::begin(kLoopbackSensors), std::end(kLoopbackSensors));
  }
  for (const std::string& assignment : overrides) {
    words.push_back("--set");
    words.push_back(assignment);
  }
  const std::string log_file = LogFile(name);
  const int pid = fork();
  if (pid < 0) throw std::runtime_error("cannot start " + name + ": " + std::strerror(errno));
  if (pid == 0) Exec(words, log_file);
  process.pid = pid;
}

void ProcessStack::SetDaemon(const std::string& name, bool on) {
  Process& process = processes_.at(name);
  process.wanted = on;
  if (!on && process.pid > 0) {
    kill(process.pid, SIGKILL);
    waitpid(process.pid, nullptr, 0);
    process.pid = 0;
  }
  if (on && process.pid == 0) Start(name, process);
}

void ProcessStack::Tend(int64_t) {
  for (auto& [name, process] : processes_) {
    if (process.pid > 0) Reap(name, process);
    if (process.pid == 0 && process.wanted && clock_.NowMicros() >= process.restart_at)
      Start(name, process);
  }
}

void ProcessStack::SendPacket(const std::string& sensor, bool position,
                              std::span<const uint8_t> packet, int64_t) {
  if (sender_) sender_->Send(sensor, position, packet);
}

void ProcessStack::SendGnss(std::span<const uint8_t> bytes) {
  if (gnss_port_) gnss_port_->Write(bytes);
}

void ProcessStack::Reap(const std::string& name, Process& process) {
  int status = 0;
  if (waitpid(process.pid, &status, WNOHANG) != process.pid) return;
  process.pid = 0;
  const int64_t now = clock_.NowMicros();
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitConfig) GiveUp(name, "refuses to start");
  std::erase_if(process.restarts, [now](int64_t t) { return now - t > kRestartWindow; });
  if (process.restarts.size() >= kMaxRestarts) GiveUp(name, "died too often");
  process.restarts.push_back(now);
  process.restart_at = now + kRestartDelay;
}

std::string ProcessStack::LogFile(const std::string& name) const {
  return options_.log_dir + "/" + name + ".log";
}

void ProcessStack::GiveUp(const std::string& name, const std::string& why) const {
  throw std::runtime_error(name + " " + why + ":" + Tail(LogFile(name)));
}

}  // namespace hairpin
