# add_daemon(NAME [SOURCES more.cpp ...] [LIBRARIES target ...])
#
# A daemon is a folder with NAME.cpp (the algorithm), NAME_node.cpp (its channels) and main.cpp.
# Makes NAME_node, a library that also runs inside the simulator's process, and the executable NAME.
function(add_daemon name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name}_node STATIC ${name}.cpp ${name}_node.cpp ${ARG_SOURCES})
  target_link_libraries(${name}_node PUBLIC common ${ARG_LIBRARIES})
  target_include_directories(${name}_node PUBLIC ${CMAKE_SOURCE_DIR})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${name}_node)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION lib/hairpin)
endfunction()
