#pragma once

#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hairpin {

/// A child process, killed at the latest when this ends. Its stdout and stderr are kept together,
/// up to what a pipe holds.
class Process {
 public:
  /// `environment` is set on top of this process's own. Throws std::runtime_error where nothing can
  /// be started.
  explicit Process(const std::vector<std::string>& command,
                   const std::vector<std::pair<std::string, std::string>>& environment = {}) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    output_ = ends[0];
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
      std::vector<char*> argv;
      for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
      argv.push_back(nullptr);
      execvp(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    descriptor_ =
        static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));  // glibc 2.36 declares it for C only
    if (descriptor_ < 0) throw std::runtime_error("no process descriptor");
  }
  ~Process() {
    if (!ended_) {
      Signal(SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(descriptor_);
    close(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Signal(int signal) const { kill(pid_, signal); }

  /// Its exit code, -signal if one ended it, or empty if it still runs after `deadline_ms`.
  std::optional<int> Wait(int deadline_ms) {
    pollfd ended{descriptor_, POLLIN, 0};
    if (poll(&ended, 1, deadline_ms) <= 0) return std::nullopt;
    int status = 0;
    waitpid(pid_, &status, 0);
    ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  /// All that it has written. Only after it has ended.
  std::string Output() const {
    std::string text;
    char buffer[4096];
    for (ssize_t n = 0; (n = read(output_, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<size_t>(n));
    return text;
  }

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  int output_ = -1;
  bool ended_ = false;
};

}  // namespace hairpin
