#include "daemons/mission_manager/startup_checks.hpp"

#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kMaxDaemons = 64;  // a hostile sender of names must not grow memory

std::vector<ClockedSensor> Sensors(const std::vector<CheckedChannel>& channels) {
  std::vector<ClockedSensor> sensors;
  for (const CheckedChannel& channel : channels) {
    if (channel.measures) sensors.push_back({channel.name, channel.deadline});
  }
  return sensors;
}

std::string Amount(double value, const char* unit) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(value < 10.0 ? 1 : 0) << value << ' ' << unit;
  return text.str();
}

}  // namespace

StartupChecks::StartupChecks(const StartupParams& params)
    : params_(params), clocks_(Sensors(params.channels), params.rate.window) {
  for (const CheckedChannel& channel : params.channels) {
    monitors_.emplace(channel.name,
                      RateMonitor(channel.name, channel.rate, channel.deadline, params.rate));
  }
  if (!(params.min_free_disk >= 0.0) || !(params.min_buffer >= 0.0))
    throw std::invalid_argument("StartupChecks: what is needed of the computer must be >= 0");
}

void StartupChecks::HeardChannel(const std::string& channel, int64_t utime, int64_t now) {
  monitors_.at(channel).Heard(now);
  clocks_.Heard(channel, utime, now);
}

void StartupChecks::HeardDaemon(const std::string& daemon, const DaemonVersion& version) {
  if (versions_.size() >= kMaxDaemons && !versions_.contains(daemon)) return;
  versions_[daemon] = version;
}

std::vector<std::string> StartupChecks::Problems(int64_t now) const {
  std::vector<std::string> problems;
  for (const CheckedChannel& channel : params_.channels) {
    const RateMonitor& monitor = monitors_.at(channel.name);
    if (!channel.needed && !monitor.heard()) continue;
    std::string problem = monitor.Problem(now);
    if (!problem.empty()) problems.push_back(std::move(problem));
  }
  for (std::string& problem : clocks_.Problems()) problems.push_back(std::move(problem));
  AddVersionProblems(problems);
  AddHostProblems(problems);
  AddConfigProblems(problems);
  return problems;
}

void StartupChecks::AddVersionProblems(std::vector<std::string>& problems) const {
  for (const auto& [daemon, version] : versions_) {
    if (version.build != params_.version.build) {
      problems.push_back(daemon + " is of another build");
    } else if (version.types_hash != params_.version.types_hash) {
      problems.push_back(daemon + " has other message types");
    }
  }
}

void StartupChecks::AddHostProblems(std::vector<std::string>& problems) const {
  if (!host_) {
    problems.emplace_back("disk: not looked at yet");
    return;
  }
  if (!host_->free_disk_gb) {
    problems.push_back("disk: " + params_.log_folder + " cannot be looked at");
  } else if (*host_->free_disk_gb < params_.min_free_disk) {
    problems.push_back("disk: " + Amount(*host_->free_disk_gb, "GB") + " free for " +
                       params_.log_folder + ", less than " + Amount(params_.min_free_disk, "GB"));
  }
  if (host_->receive_buffer_kb && *host_->receive_buffer_kb < params_.min_buffer) {
    problems.push_back("buffers: the kernel gives a socket " +
                       Amount(*host_->receive_buffer_kb, "kB") + ", less than " +
                       Amount(params_.min_buffer, "kB") + " (sysctl net.core.rmem_max)");
  }
}

void StartupChecks::AddConfigProblems(std::vector<std::string>& problems) const {
  for (const auto& [daemon, version] : versions_) {
    if (version.car_hash == 0) {
      problems.push_back("config: " + daemon + " found no car.yaml");
    } else if (version.car_hash != params_.version.car_hash) {
      problems.push_back("config: " + daemon + " has another car.yaml");
    }
  }
}

}  // namespace hairpin
