# Runs PROGRAM as it is and with glibc's vector variants off; both must print the same hashes.
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE plain RESULT_VARIABLE failed)
execute_process(COMMAND ${CMAKE_COMMAND} -E env
                "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-AVX_Usable,-AVX2_Usable,-FMA,-FMA_Usable,-AVX512F,-AVX512VL,-SSE4_1,-SSE4_2,-AVX_Fast_Unaligned_Load"
                ${PROGRAM} OUTPUT_VARIABLE without RESULT_VARIABLE failed_too)
if(failed OR failed_too OR plain STREQUAL "" OR NOT plain STREQUAL without)
  message(FATAL_ERROR "hashes differ with vector extensions off:\n${plain}\nagainst\n${without}")
endif()
message(STATUS "same hashes with and without:\n${plain}")
