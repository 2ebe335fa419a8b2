# Replays a generated drive and compares the hash of its traces with the committed one. A difference between machines is a
# defect; after an intended change of the firmware: -DUPDATE=1 writes the new hash (a change indicator, not a truth).
# Run: cmake -DMAKE=<make_frames> -DTRACTIOND=<tractiond> -DWRAP=<emulator;args> -DFRAMES=<out> -DEXPECTED=<file> -P check_hash.cmake
execute_process(COMMAND ${WRAP} ${MAKE} ${FRAMES} RESULT_VARIABLE made)
execute_process(COMMAND ${WRAP} ${TRACTIOND} --hal replay --hash ${FRAMES} OUTPUT_VARIABLE got RESULT_VARIABLE replayed ERROR_VARIABLE said)
if(NOT made EQUAL 0 OR NOT replayed EQUAL 0)
  message(FATAL_ERROR "the replay did not run: ${made} ${replayed} ${said}")
endif()
string(STRIP "${got}" got)
if(UPDATE)
  file(WRITE ${EXPECTED} "${got}\n")
endif()
file(READ ${EXPECTED} expected)
string(STRIP "${expected}" expected)
if(NOT got STREQUAL expected)
  message(FATAL_ERROR "the traces have hash ${got}, ${EXPECTED} says ${expected}")
endif()
message(STATUS "traces: ${got}")
