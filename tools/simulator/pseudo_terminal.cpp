#include "tools/simulator/pseudo_terminal.hpp"

#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace hairpin {

PseudoTerminal::PseudoTerminal() {
  std::array<char, 128> name{};
  termios raw{};
  cfmakeraw(&raw);  // nothing is echoed, and no byte is a command
  cfsetspeed(&raw, B115200);
  if (openpty(&master_, &slave_, name.data(), &raw, nullptr) != 0)
    throw std::runtime_error(std::string("no pseudo terminal: ") + std::strerror(errno));
  for (const int descriptor : {master_, slave_}) fcntl(descriptor, F_SETFD, FD_CLOEXEC);
  fcntl(master_, F_SETFL, O_NONBLOCK);
  path_ = name.data();
}

PseudoTerminal::~PseudoTerminal() {
  close(master_);
  close(slave_);
}

size_t PseudoTerminal::Write(std::span<const uint8_t> bytes) {
  const ssize_t count = write(master_, bytes.data(), bytes.size());
  return count > 0 ? static_cast<size_t>(count) : 0;
}

size_t PseudoTerminal::Unread() const {
  int count = 0;
  if (ioctl(slave_, FIONREAD, &count) != 0) return 0;
  return static_cast<size_t>(count);
}

}  // namespace hairpin
