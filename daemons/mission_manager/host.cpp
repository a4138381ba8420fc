#include "daemons/mission_manager/host.hpp"

#include <sys/socket.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace hairpin {

std::optional<double> FreeDiskGb(const std::string& folder) {
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
  return 1e-9 * static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
}

std::optional<double> ReceiveBufferKb(const std::string& url) {
  const std::string key = "recv_buf_size=";
  const size_t at = url.find(key);
  if (at == std::string::npos) return std::nullopt;
  int size = std::atoi(url.c_str() + at + key.size());
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) throw std::runtime_error(std::string("UDP socket: ") + std::strerror(errno));
  setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  int given = 0;
  socklen_t length = sizeof given;
  getsockopt(probe, SOL_SOCKET, SO_RCVBUF, &given, &length);
  close(probe);
  // Linux doubles what it grants, for its own bookkeeping [socket(7)].
  return 0.5e-3 * given;
}

}  // namespace hairpin
