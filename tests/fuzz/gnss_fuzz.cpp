// The border at which bytes from the serial port become fixes. Whatever comes, nothing may crash or
// throw; a fix is finite, on Earth, and later than the one before; and the bytes mean the same
// however they are cut.
//
// An input is where to cut it (first byte), and the bytes.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "daemons/gnss_driver/gnss_driver.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const hairpin::GnssErrorModel errors{2.5, 1.0, 0.3, 0.015, 1.5, 0.05, 0.005};
  const hairpin::Bytes bytes(data + 1, size - 1);
  hairpin::GnssDecoder whole(errors);
  const std::vector<hairpin::GnssFix> fixes = whole.Add(bytes);
  int64_t last = INT64_MIN;
  for (const hairpin::GnssFix& fix : fixes) {
    Insist(fix.utime > last);
    last = fix.utime;
    Insist(std::abs(fix.position.latitude_deg) <= 90.0);
    Insist(std::abs(fix.position.longitude_deg) <= 180.0);
    Insist(fix.velocity.allFinite() && fix.position_sigma.allFinite());
    Insist(!fix.heading || std::isfinite(*fix.heading));
  }
  hairpin::GnssDecoder cut(errors);
  const size_t at = bytes.size() * data[0] / 255;
  const size_t count = cut.Add(bytes.first(at)).size() + cut.Add(bytes.subspan(at)).size();
  Insist(count == fixes.size() && cut.bad() == whole.bad());
  return 0;
}
