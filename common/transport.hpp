#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

namespace hairpin {

/// The car's own network: multicast that never leaves the host, with room for a burst of large
/// messages.
inline constexpr const char* kDefaultLcmUrl =
    "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

/// One LCM instance (udpm://, memq://), with errors carried safely over its C frames: an exception
/// that leaves a handler would ruin the instance, so it is caught there, kept, and thrown again
/// once LCM has returned.
class Transport {
 public:
  /// Throws std::runtime_error where the URL cannot be opened, with a hint for a missing multicast
  /// route.
  explicit Transport(const std::string& url);

  /// Waits up to `timeout_ms` and handles one message. Returns false if none came. Rethrows what a
  /// handler threw.
  bool Handle(int timeout_ms);
  /// Handles messages until none is waiting, the ones published meanwhile included.
  void Drain();
  /// Readable while a message waits: for whom waits on other descriptors too.
  int descriptor() { return lcm_.getFileno(); }

  using RawHandler =
      std::function<void(const std::string& channel, const uint8_t* data, size_t size)>;
  /// A subscription ends when its handle is destroyed, which must not happen inside a handler.
  class RawSubscription;
  /// Bytes as they come, on every channel that the regular expression matches as a whole.
  [[nodiscard]] std::shared_ptr<RawSubscription> Subscribe(const std::string& channel_regex,
                                                           RawHandler handler);
  void Publish(const std::string& channel, const uint8_t* data, size_t size);

  const std::string& url() const { return url_; }

 private:
  std::string url_;
  lcm::LCM lcm_;
  std::exception_ptr error_;
};

}  // namespace hairpin
