#pragma once

#include <stdexcept>

namespace hairpin {

// What a program's exit code says.
inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitConfig = 78;  // EX_CONFIG; systemd does not restart it

/// A program was asked for what it does not do: exits with kExitUsage.
class UsageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A config, track, map or recording that cannot be used: exits with kExitConfig. Its text begins
/// with the file's name.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hairpin
