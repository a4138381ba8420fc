#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemons/mission_manager/startup_checks.hpp"

namespace hairpin {

/// What is free in the file system of `folder` for one who is not root [GB]; empty where it cannot
/// be looked at.
std::optional<double> FreeDiskGb(const std::string& folder);

/// What the kernel gives a socket that asks for as much as `url` does in `recv_buf_size=` [kB];
/// empty where it asks for none, as memq:// does. Throws std::runtime_error without a socket.
std::optional<double> ReceiveBufferKb(const std::string& url);

/// Looks at both.
inline std::function<HostFacts()> ThisHost(const std::string& log_folder, const std::string& url) {
  return [log_folder, url] { return HostFacts{FreeDiskGb(log_folder), ReceiveBufferKb(url)}; };
}

}  // namespace hairpin
