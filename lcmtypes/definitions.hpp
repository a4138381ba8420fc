#pragma once

namespace hairpin {

/// The text of every .lcm file, one after another: what a wire check or a viewer needs to walk a
/// message without its class.
extern const char* const kMessageDefinitions;

}  // namespace hairpin
