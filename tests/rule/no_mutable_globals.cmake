# A library owns no mutable globals: nm finds no writable data symbol (b B d D s S C).
# Run: cmake -DNM=nm -DLIBRARY=libx.a -P no_mutable_globals.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${NM} ${LIBRARY} OUTPUT_VARIABLE symbols ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR NOT symbols MATCHES " [Tt] ")
  message(FATAL_ERROR "${NM} read no function from ${LIBRARY}: the rule was not checked")
endif()
string(REGEX MATCHALL "[^\n]* [bBdDsSC] [^\n]*" mutable "${symbols}")
# relocatable read-only tables (.data.rel.ro) are constant at run time, and nm shows them as d
list(FILTER mutable EXCLUDE REGEX "\\.data\\.rel\\.ro")
if(mutable)
  string(REPLACE ";" "\n" mutable "${mutable}")
  # NOTICE: an error's text is wrapped by CMake, where depends on the path's length
  message(NOTICE "${LIBRARY}:\n${mutable}")
  message(FATAL_ERROR "mutable globals in a library")
endif()
