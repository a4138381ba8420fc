# Writes BuildId() of the checkout DIR to OUT: its commit, with -dirty where tracked files differ from it. Runs at each
# build, and leaves OUT as it is where nothing changed, so that nothing is compiled anew.
cmake_minimum_required(VERSION 3.25)
find_package(Git QUIET)
set(described "")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} --no-optional-locks -C ${DIR} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT described)
  set(described "unknown")
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY
  CONTENT "#include \"common/daemon.hpp\"\n\nnamespace hairpin {\nconst char* BuildId() { return \"@described@\"; }\n}\n")
