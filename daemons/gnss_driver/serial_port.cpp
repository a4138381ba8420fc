#include "daemons/gnss_driver/serial_port.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace hairpin {
namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kBaudRates{{{9600, B9600},
                                                             {19200, B19200},
                                                             {38400, B38400},
                                                             {57600, B57600},
                                                             {115200, B115200},
                                                             {230400, B230400},
                                                             {460800, B460800},
                                                             {921600, B921600}}};

const std::pair<int, speed_t>* FindBaudRate(int baud_rate) {
  const auto* found =
      std::find_if(kBaudRates.begin(), kBaudRates.end(),
                   [baud_rate](const auto& known) { return known.first == baud_rate; });
  return found == kBaudRates.end() ? nullptr : found;
}

}  // namespace

bool SerialPort::IsBaudRate(int baud_rate) { return FindBaudRate(baud_rate) != nullptr; }

SerialPort::SerialPort(const std::string& path, int baud_rate) : path_(path) {
  const auto* rate = FindBaudRate(baud_rate);
  if (!rate) throw std::runtime_error(path + ": no such baud rate");
  descriptor_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) throw std::runtime_error(path + ": " + std::strerror(errno));
  termios settings{};
  bool is_set = tcgetattr(descriptor_, &settings) == 0;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  is_set = is_set && cfsetispeed(&settings, rate->second) == 0 &&
           cfsetospeed(&settings, rate->second) == 0 &&
           tcsetattr(descriptor_, TCSANOW, &settings) == 0;
  if (is_set) return;
  const std::string why = std::strerror(errno);
  close(descriptor_);
  throw std::runtime_error(path + ": cannot be set up as a serial port: " + why);
}

SerialPort::~SerialPort() { close(descriptor_); }

size_t SerialPort::Read(std::span<uint8_t> buffer) {
  const ssize_t count = read(descriptor_, buffer.data(), buffer.size());
  if (count > 0) return static_cast<size_t>(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  throw std::runtime_error(path_ + ": " + (count < 0 ? std::strerror(errno) : "is gone"));
}

}  // namespace hairpin
