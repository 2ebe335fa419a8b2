# firmware/core names no heap, I/O, clock, double or libm transcendental: every file compiles behind poison.h.
# Run: cmake -DCC=cc -DROOT=<tree> -DPOISON=<poison.h> -DINCLUDE=<dir;dir> -P poisoned_identifiers.cmake
cmake_minimum_required(VERSION 3.25)
file(GLOB files ${ROOT}/firmware/core/*.c)
if(NOT files)
  message(FATAL_ERROR "no C file in ${ROOT}/firmware/core: the rule was not checked")
endif()
set(include_flags "")
foreach(directory IN LISTS INCLUDE)
  list(APPEND include_flags -I${directory})
endforeach()
set(offences "")
foreach(file IN LISTS files)
  execute_process(COMMAND ${CC} -std=c11 -fsyntax-only -I${ROOT} ${include_flags} -include ${POISON} ${file}
    ERROR_VARIABLE message RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(APPEND offences "${message}\n")
  endif()
endforeach()
if(offences)
  # NOTICE: an error's text is wrapped by CMake, where depends on the path's length
  message(NOTICE "${offences}")
  message(FATAL_ERROR "poisoned identifiers in firmware/core")
endif()
