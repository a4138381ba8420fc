// The border at which bytes from the network become messages. Whatever comes, nothing may crash,
// throw or allocate by a length that stands in the bytes; and what is accepted is finite and
// understood to its last byte.
//
// An input is a channel (first byte), whether the type's own fingerprint is put in front (second
// byte), and the payload.

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "common/bus.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

std::vector<uint8_t> Fingerprint(int64_t hash) {
  std::vector<uint8_t> bytes;
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<uint8_t>(static_cast<uint64_t>(hash) >> shift));
  return bytes;
}

template <class M>
void Deliver(const hairpin::Channel<M>& channel, bool typed, const uint8_t* data, size_t size) {
  std::vector<uint8_t> payload = typed ? Fingerprint(M::getHash()) : std::vector<uint8_t>{};
  payload.insert(payload.end(), data, data + size);
  hairpin::Transport transport("memq://");
  hairpin::Bus bus(transport, "fuzz", 1);
  int64_t heard = 0;
  bus.Subscribe(channel, [&](const M& message) {
    ++heard;
    std::vector<uint8_t> again(static_cast<size_t>(message.getEncodedSize()));
    message.encode(again.data(), 0, static_cast<int>(again.size()));
    Insist(again == payload);
  });
  transport.Publish(channel.name, payload.data(), payload.size());
  transport.Publish(channel.name, payload.data(), payload.size());
  transport.Drain();
  const hairpin::channel_health_t health = bus.Health().front();
  Insist(heard == health.received && heard <= 1);
  Insist(health.received + health.undecodable + health.duplicates + health.implausible_time == 2);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::cerr.rdbuf(nullptr);  // the bus's warnings
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  static const int num_channels = [] {
    int count = 0;
    hairpin::ForEachChannel([&count](const auto&) { ++count; });
    return count;
  }();
  int index = data[0] % num_channels;
  hairpin::ForEachChannel([&](const auto& channel) {
    if (index-- == 0) Deliver(channel, data[1] % 4 != 0, data + 2, size - 2);
  });
  return 0;
}
