# Who may include whom (docs/architecture.md, include table). Run: cmake -DROOT=<tree> -P include_rule.cmake
# Fails with one line per offending include.
cmake_minimum_required(VERSION 3.25)
set(same_folder "[^/]+")
# folder | project includes it may name | system includes it may name ("" = any)
set(rules
  "firmware/core|${same_folder}|firmware/core/.+|stdint.h|stdbool.h|stddef.h|math.h"
  "firmware/template|${same_folder}|firmware/core/.+|*"  # a template from a radar's numbers: the build machine, the host
  "firmware/link|${same_folder}|firmware/core/.+|*"  # protocol alone: its files and sockets are firmware/app's
  "firmware/flash|${same_folder}|*"  # libc alone: the installer knows nothing of what it installs
  "firmware/app|${same_folder}|firmware/(core|app|link)/.+|hal/(hal|open|forward|pace/pace_hal|replay/frames).h|*"
  "hal|${same_folder}|firmware/core/signals.h|hal/.+|*"
  "hal/sim|${same_folder}|firmware/core/signals.h|hal/.+|sim/.+|*"
  "sim|${same_folder}|sim/.+|*"
  "emulate|${same_folder}|*"  # on the board, beside the firmware: nothing of it
  "host_tools|${same_folder}|(firmware|hal|sim|host_tools)/.+|*"
  "host_tools/emulate|${same_folder}|(firmware|hal|sim|host_tools)/.+|emulate/lockstep.h|*"
  "python|${same_folder}|(firmware|hal|sim|host_tools)/.+|*")
# The lab's rooms, in the order in which data goes through them: a room includes itself and the rooms before it. session.h opens model and
# log for whoever uses the lab, through the gate (host_tools/check), so that it may look into every room and none looks back.
set(rooms model inputs forward fit decision next result)
list(APPEND rules "host_tools/lab|${same_folder}|sim/physics/.+|host_tools/(log|check)/.+|host_tools/lab/.+|*")
set(earlier "")
foreach(room IN LISTS rooms)
  string(APPEND earlier "|host_tools/lab/${room}/.+")
  list(APPEND rules "host_tools/lab/${room}|${same_folder}|sim/physics/.+|host_tools/(log|suggest)/.+${earlier}|*")
endforeach()
# System headers that are somebody's own: folder that may have them
set(owned "linux/.+=(hal/linux|emulate)" "gpiod.h=hal/linux" "sys/socket.h=(hal/linux|firmware/app|host_tools|emulate)"
  "ode/.+=sim/plant|tests" "ceres/.+=host_tools/lab" "muParser.h=host_tools/(lab|log)")

set(offences "")
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/firmware/*.[ch] ${ROOT}/hal/*.[ch] ${ROOT}/hal/*.cpp ${ROOT}/sim/*.h
  ${ROOT}/sim/*.cpp ${ROOT}/host_tools/*.h ${ROOT}/host_tools/*.cpp ${ROOT}/emulate/*.[ch] ${ROOT}/python/*.h ${ROOT}/python/*.cpp)
foreach(file IN LISTS files)
  set(rule "")
  foreach(candidate IN LISTS rules) # the last that matches is the most specific
    string(REGEX REPLACE "\\|.*" "" folder "${candidate}")
    if(file MATCHES "^${folder}/")
      set(rule "${candidate}")
    endif()
  endforeach()
  string(REPLACE "|" ";" allowed "${rule}")
  list(POP_FRONT allowed folder)
  string(REPLACE ";" "|" allowed "${allowed}")
  string(REGEX REPLACE "\\|?\\*" "" allowed_names "${allowed}")
  file(STRINGS ${ROOT}/${file} lines REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS lines)
    if(line MATCHES "include[ \t]*\"([^\"]+)\"")
      set(header "${CMAKE_MATCH_1}")
      if(NOT header MATCHES "^(${allowed_names})$")
        string(APPEND offences "${file} may not include \"${header}\"\n")
      endif()
    elseif(line MATCHES "include[ \t]*<([^>]+)>")
      set(header "${CMAKE_MATCH_1}")
      if(NOT allowed MATCHES "\\*" AND NOT header MATCHES "^(${allowed_names})$")
        string(APPEND offences "${file} may not include <${header}>\n")
      endif()
      foreach(entry IN LISTS owned)
        string(REGEX REPLACE "=.*" "" owned_header "${entry}")
        string(REGEX REPLACE ".*=" "" owner "${entry}")
        if(header MATCHES "^${owned_header}$" AND NOT file MATCHES "^(${owner})/")
          string(APPEND offences "${file} may not include <${header}>: that is ${owner}'s\n")
        endif()
      endforeach()
    endif()
  endforeach()
endforeach()
list(LENGTH files count)
if(count EQUAL 0)
  message(FATAL_ERROR "no source files under ${ROOT}: the rule was not checked")
endif()
if(offences)
  # NOTICE: an error's text is wrapped by CMake, where depends on the path's length
  message(NOTICE "${offences}")
  message(FATAL_ERROR "include rule broken")
endif()
message(STATUS "include rule holds in ${count} files")
