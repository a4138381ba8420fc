#include "daemons/gnss_driver/gnss_driver_process.hpp"

#include <array>
#include <iostream>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr int64_t kRetryPeriod = 1'000'000;  // us
constexpr int kReadsPerPoll = 16;            // a receiver that floods must not hold up the rest

}  // namespace

GnssDriverProcess::GnssDriverProcess(const GnssDriverParams& params, Bus& bus, const Clock& clock)
    : params_(params), name_(bus.daemon()), clock_(clock), node_(params, bus) {
  TryToOpen();
}

std::vector<int> GnssDriverProcess::descriptors() const {
  return port_ ? std::vector<int>{port_->descriptor()} : std::vector<int>{};
}

void GnssDriverProcess::TryToOpen() {
  const int64_t now = clock_.NowMicros();
  if (last_try_ && now - *last_try_ < kRetryPeriod) return;
  last_try_ = now;
  try {
    port_ = std::make_unique<SerialPort>(params_.port, params_.baud_rate);
  } catch (const std::runtime_error& error) {
    Warn(error.what());
  }
}

void GnssDriverProcess::Poll() {
  if (!port_) TryToOpen();
  std::array<uint8_t, 1024> buffer;
  for (int i = 0; port_ && i < kReadsPerPoll; ++i) {
    try {
      const size_t count = port_->Read(buffer);
      if (count == 0) break;
      node_.OnBytes(Bytes(buffer).first(count));
    } catch (const std::runtime_error& error) {
      Warn(error.what());
      port_.reset();
    }
  }
}

// At most once a second: there may be no data, and so no data time.
void GnssDriverProcess::Warn(const std::string& why) {
  const int64_t now = clock_.NowMicros();
  if (last_warning_ && now - *last_warning_ < kRetryPeriod) return;
  last_warning_ = now;
  std::cerr << name_ << ": " << why << '\n';
}

}  // namespace hairpin
