# traction_c_library / traction_cxx_library / traction_test: our targets, with our warnings (as errors with TRACTION_WERROR).
set(TRACTION_WARNINGS -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wundef -Wdouble-promotion -Wcast-align
    -Wcast-qual -Wwrite-strings -Wpointer-arith -Wformat=2 -Wswitch-enum -Wvla)
if(TRACTION_WERROR)
  list(APPEND TRACTION_WARNINGS -Werror)
endif()
set(TRACTION_C_WARNINGS ${TRACTION_WARNINGS} -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition)
set(TRACTION_CXX_WARNINGS ${TRACTION_WARNINGS} -Wnon-virtual-dtor -Woverloaded-virtual -Wextra-semi
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>) # GCC 12 sees an overlap in "literal" + std::string where there is none (its bug 105651)

# GCC collects its garbage from 128 MB on by default, and our C++ files need up to 900 MB: from 400 MB on, a sixth of their time is
# saved (docs/performance.md) for 100 MB a job.
set(TRACTION_COMPILER_MEMORY "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-expand=100 --param ggc-min-heapsize=400000>")

# Applies warnings and the floating-point contract (-ffp-contract=off: no fused multiply-add, so x86 and ARM agree).
function(traction_own target)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:C>:${TRACTION_C_WARNINGS}> $<$<COMPILE_LANGUAGE:CXX>:${TRACTION_CXX_WARNINGS}> -ffp-contract=off ${TRACTION_COMPILER_MEMORY})
  target_compile_features(${target} PUBLIC c_std_11)
  if(NOT CMAKE_CROSSCOMPILING)
    target_compile_features(${target} PUBLIC cxx_std_20)
  endif()
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  if(TRACTION_SANITIZE)
    target_compile_options(${target} PUBLIC $<$<CONFIG:Debug>:-O1> -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>) # GCC's guess is wrong in the library's own headers once these are on
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# With TRACTION_TOGETHER several C++ files are compiled as one, so that headers are read and templates instantiated once for all of them.
# What that saves, and that answers stay: tests/bench/first_build.sh. Who changes Traction builds file by file. The largest takes 1.3 GB:
# no more of them at a time than the machine's memory holds.
if(TRACTION_TOGETHER)
  cmake_host_system_information(RESULT memory_MB QUERY TOTAL_PHYSICAL_MEMORY)
  math(EXPR jobs "${memory_MB} / 2000 + 1")
  set_property(GLOBAL APPEND PROPERTY JOB_POOLS together=${jobs})
endif()
function(traction_together target)
  if(TRACTION_TOGETHER AND NOT CMAKE_CROSSCOMPILING)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10 JOB_POOL_COMPILE together)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow>) # of one file's names by another's
  endif()
endfunction()

# traction_library(NAME sources...)
function(traction_library name)
  add_library(${name} STATIC ${ARGN})
  traction_own(${name})
  string(FIND "${CMAKE_CURRENT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/tests" of_tests)
  if(ARGN MATCHES "\\.cpp" AND NOT of_tests EQUAL 0) # rule_one_name reads sim, hal and host_tools
    traction_together(${name})
  endif()
endfunction()

# traction_headers(NAME headers...): what nearly every file of that target includes is read once. A file still names what it uses:
# the dev preset compiles without (CMAKE_DISABLE_PRECOMPILE_HEADERS), but for the tests.
function(traction_headers name)
  target_precompile_headers(${name} PRIVATE ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(options $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>) # lets ccache see the header's contents
  else()
    set(options "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
  endif()
  target_compile_options(${name} PRIVATE ${options})
  set_target_properties(${name} PROPERTIES TRACTION_HEADER_OPTIONS "${options}")
endfunction()

# traction_same_headers(NAME OTHER): the headers that OTHER has read, compiled with the same options.
function(traction_same_headers name other)
  target_precompile_headers(${name} REUSE_FROM ${other})
  get_target_property(options ${other} TRACTION_HEADER_OPTIONS)
  target_compile_options(${name} PRIVATE ${options})
endfunction()

# traction_waits(NAME): this target waits for people, files and its libraries, so its code is compiled for a short build.
function(traction_waits name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What the sanitized build (preset dev) runs: every test of firmware, HAL and log, and of the simulator those that go through its code
# within seconds. To compile the lab so takes longer than all of that: it runs in the host build, and under sanitizers in the preset sanitize.
set(TRACTION_SANITIZED_LABELS unit hal replay)
set(TRACTION_SANITIZED_TESTS effects_test math_test soil_law_test sensor_effects_test plant_soft_test scenario_test fault_test)

# traction_test(NAME LABEL label [COST s] [TIMEOUT s] [NIGHTLY pattern...] SOURCES ... LIBS ...): one GoogleTest executable, one ctest entry,
# run under the emulator when cross-compiling. COST: about its seconds on the host, of those that take more than a few: ctest starts the
# dearest first, so that none of them is left to run alone at the end. What the patterns name takes long beside what it adds: every night,
# with all the rest, as NAME_whole (ctest --preset host -C nightly), so that the daily suite stays short (goal: ten minutes).
# OWN_HEADERS: a library's definitions change what the headers say, so it reads them itself.
function(traction_test name)
  cmake_parse_arguments(T "OWN_HEADERS" "LABEL;TIMEOUT;COST" "SOURCES;LIBS;NIGHTLY" ${ARGN})
  if(TRACTION_SANITIZE AND NOT TRACTION_SANITIZE_EVERY AND NOT T_LABEL IN_LIST TRACTION_SANITIZED_LABELS AND NOT name IN_LIST TRACTION_SANITIZED_TESTS)
    return()
  endif()
  add_executable(${name} ${T_SOURCES})
  set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL OFF) # also where its folder is
  traction_own(${name})
  target_link_libraries(${name} PRIVATE ${T_LIBS} GTest::gtest GTest::gtest_main)
  # gtest's macros convert and shadow in ways that are theirs, not ours; and with -O1 GCC 12 sees std::string("long literal") + "/" leave
  # its bounds, where -O3 sees that it does not
  target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-undef -Wno-switch-enum>
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-array-bounds -Wno-stringop-overflow>)
  traction_waits(${name}) # for what it tests, which is compiled for speed
  set_target_properties(${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS OFF) # a file of a product names what it uses, a test need not
  if("traction_lab" IN_LIST T_LIBS)
    traction_same_headers(${name} lab_test_headers)
  elseif(NOT T_OWN_HEADERS AND NOT CMAKE_CROSSCOMPILING AND NOT T_SOURCES MATCHES "\\.c(;|$)") # of C there is none
    traction_same_headers(${name} test_headers)
  endif()
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  if(NOT T_COST)
    set(T_COST 2)
  endif()
  if(TRACTION_SANITIZE)
    math(EXPR T_TIMEOUT "4 * ${T_TIMEOUT}") # the sanitizers' price
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${T_LABEL} TIMEOUT ${T_TIMEOUT} COST ${T_COST})
  if(T_NIGHTLY)
    list(JOIN T_NIGHTLY ":" patterns)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT "GTEST_FILTER=-${patterns}")
    add_test(NAME ${name}_whole CONFIGURATIONS nightly COMMAND ${name} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name}_whole PROPERTIES LABELS "${T_LABEL};long" TIMEOUT 1800)
  endif()
endfunction()

# traction_waiting_test(NAME PLACE): a test that mostly waits, for a rover in real time or for a page to draw. These run
# one after the other by PLACE, from the beginning on, and each takes one of the three places of the preset: the two processors are left to
# tests that compute. Two of them at once would leave a processor idle, and disturb each other.
function(traction_waiting_test name place)
  math(EXPR cost "1000 - ${place}") # before all that compute
  set_tests_properties(${name} PROPERTIES RESOURCE_LOCK clock COST ${cost})
endfunction()
