#pragma once

#include <string_view>
#include <vector>

#include "daemons/watchdog/source.hpp"

namespace hairpin {

/// Every channel of the car with what its faults mean (FAULTS), in the order of the channel table,
/// whose rates and deadlines they have. The simulator's truth is not among them: no daemon may hear
/// it; HEARTBEAT is judged by daemon.
std::vector<SourceSpec> WatchedChannels();

/// The daemons without which the car does not drive on as before. Others are only named.
std::vector<SourceSpec> WatchedDaemons();

/// Index of a channel in `WatchedChannels()`. Throws std::out_of_range for one that is not watched.
size_t WatchedChannelIndex(std::string_view name);

}  // namespace hairpin
