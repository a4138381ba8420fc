#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace hairpin {

/// A serial port without a wire: what is written here, a driver reads from the device at path().
class PseudoTerminal {
 public:
  /// Throws std::runtime_error where the system has none.
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& path() const { return path_; }
  /// Bytes taken; the rest is lost, as on a wire that nobody reads from.
  size_t Write(std::span<const uint8_t> bytes);
  /// Bytes that wait for a reader.
  size_t Unread() const;

 private:
  int master_ = -1;
  int slave_ = -1;  // held open, so that the device outlives its reader
  std::string path_;
};

}  // namespace hairpin
