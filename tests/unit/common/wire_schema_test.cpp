#include "common/wire_schema.hpp"

#include <gtest/gtest.h>

#include "common/channels.hpp"

namespace hairpin {
namespace {

TEST(WireSchema, AcceptsEveryMessageOfTheChannelTable) {
  ForEachChannel([](const auto& channel) {
    using Message = typename std::decay_t<decltype(channel)>::Message;
    Message message{};
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    EXPECT_EQ(WireSchema::Hairpin().Problem(Message::getTypeName(), bytes.data() + 8, bytes.size() - 8), "") << channel.name;
  });
}

}  // namespace
}  // namespace hairpin
