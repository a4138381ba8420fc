#pragma once

namespace hairpin {

/// All of hairpin-track: results on stdout, messages on stderr. Returns the exit code: 0 done, 1
/// ran and failed, 2 wrong usage, 78 a file that is no track.
int RunTrackCommand(int argc, const char* const* argv);

}  // namespace hairpin
