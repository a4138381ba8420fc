#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace hairpin {

/// A serial port, opened for reading and writing: raw, 8N1, no flow control, never blocking.
class SerialPort {
 public:
  /// Throws std::runtime_error: "PATH: why".
  SerialPort(const std::string& path, int baud_rate);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  int descriptor() const { return descriptor_; }
  /// The bytes that have come, 0 where none have. Throws std::runtime_error once the port is gone.
  size_t Read(std::span<uint8_t> buffer);

  static bool IsBaudRate(int baud_rate);

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace hairpin
