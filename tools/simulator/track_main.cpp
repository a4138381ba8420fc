// hairpin-track: makes, checks, draws and converts tracks. `tools/track` builds and calls it.
#include "tools/simulator/track_command.hpp"

int main(int argc, char** argv) { return hairpin::RunTrackCommand(argc, argv); }
