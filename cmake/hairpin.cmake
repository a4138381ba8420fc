# add_daemon(NAME [SOURCES more.cpp ...] [LIBRARIES target ...] [INSTANCES name ...] [MEMORY 256M])
#
# A daemon is a folder with NAME.cpp (the algorithm), NAME_node.cpp (its channels), main.cpp and README.md.
# Makes NAME_node, a library that also runs inside the simulator's process, the executable NAME, and its systemd unit:
# hairpin-NAME.service, or hairpin-NAME@.service where it runs as several instances (`NAME --instance INSTANCE`).
# MEMORY is the unit's limit. config/systemd/NAME.conf, if there is one, becomes a drop-in of the unit.
function(add_daemon name)
  cmake_parse_arguments(ARG "" "MEMORY" "SOURCES;LIBRARIES;INSTANCES" ${ARGN})
  add_library(${name}_node STATIC ${name}.cpp ${name}_node.cpp ${ARG_SOURCES})
  target_link_libraries(${name}_node PUBLIC common ${ARG_LIBRARIES})
  target_include_directories(${name}_node PUBLIC ${CMAKE_SOURCE_DIR})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${name}_node)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  if(NOT ARG_MEMORY)
    set(ARG_MEMORY 256M)
  endif()
  install_daemon(${name} ${ARG_MEMORY} "${ARG_INSTANCES}")
endfunction()
