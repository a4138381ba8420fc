#include "common/channels.hpp"

namespace hairpin {

int64_t TypesHash() {
  uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, over the fingerprints' words
  ForEachChannel([&hash](const auto& channel) {
    using Message = typename std::decay_t<decltype(channel)>::Message;
    hash = (hash ^ static_cast<uint64_t>(Message::getHash())) * 0x100000001b3u;
  });
  return static_cast<int64_t>(hash);
}

}  // namespace hairpin
