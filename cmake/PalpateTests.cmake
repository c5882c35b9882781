# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Test programs, and which of their cases belong to the day and which to the night.
#
# Tests of the day are short and the same in every run. A test belongs to the night (label nightly)
# where it takes more than 10 s, draws random robots, runs in real time or repeats a statistic.
# Targets: tests builds what the tests of the day need, nightly what all tests need.
include(GoogleTest)
add_custom_target(tests)
add_custom_target(nightly)
add_dependencies(tests programs)
add_dependencies(nightly tests manuals)

# add_component_test(NAME [FOLDERS folder...] [SOURCES file...] [LIBS lib...] [PRIVATE target...]
#                    [RUNS program...] [LOOPBACK] [NO_PCH]
#                    [NIGHTLY] [NIGHTLY_CASES regex...] [ALONE_CASES regex...])
# One test program from the sources of FOLDERS (default: this folder) and SOURCES. Each of its cases
# is a test of ctest, named NAME.Suite.Case. Regular expressions are of the beginning of Suite.Case.
#   RUNS           programs that it starts
#   LOOPBACK       DDS on 127.0.0.1 only, with a domain id of its own: tests run in parallel and
#                  never meet
#   NO_PCH         without the precompiled header
#   NIGHTLY        the whole program belongs to the night; the day does not even build it
#   NIGHTLY_CASES  these cases belong to the night
#   ALONE_CASES    nothing runs beside these, because they keep a rate
function(add_component_test name)
  cmake_parse_arguments(ARG "LOOPBACK;NO_PCH;NIGHTLY" ""
    "FOLDERS;SOURCES;LIBS;PRIVATE;RUNS;NIGHTLY_CASES;ALONE_CASES" ${ARGN})
  if(NOT ARG_FOLDERS)
    set(ARG_FOLDERS .)
  endif()
  list(TRANSFORM ARG_FOLDERS APPEND "/*.cpp")
  file(GLOB sources CONFIGURE_DEPENDS ${ARG_FOLDERS})
  list(TRANSFORM ARG_LIBS PREPEND palpate::)
  set(program ${name}_test)
  add_executable(${program} ${sources} ${ARG_SOURCES})
  target_link_libraries(${program} PRIVATE ${ARG_LIBS} ${ARG_PRIVATE} GTest::gmock
                        GTest::gtest_main)
  palpate_own_code(${program} PCH palpate_test_pch)
  if(ARG_NO_PCH)
    set_target_properties(${program} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
  target_compile_definitions(${program} PRIVATE
    PALPATE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PALPATE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  set_target_properties(${program} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  if(ARG_RUNS)
    add_dependencies(${program} ${ARG_RUNS})
  endif()
  if(ARG_NIGHTLY)
    add_dependencies(nightly ${program})
  else()
    add_dependencies(tests ${program})
  endif()
  gtest_discover_tests(${program} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST)
  palpate_set_test_properties(${name})
endfunction()

# Only ctest knows the cases, and only after the discovery: a script that it reads then sets the
# properties (test_properties.cmake). Takes the arguments of add_component_test from its caller.
function(palpate_set_test_properties name)
  set(environment "")
  set(lock "")
  if(ARG_LOOPBACK)
    get_property(domain GLOBAL PROPERTY PALPATE_NEXT_TEST_DOMAIN)
    if(NOT domain)
      set(domain 20)
    endif()
    math(EXPR next "${domain} + 1")
    set_property(GLOBAL PROPERTY PALPATE_NEXT_TEST_DOMAIN ${next})
    set(environment "ROS_DOMAIN_ID=${domain}"
        "CYCLONEDDS_URI=file://${PROJECT_SOURCE_DIR}/tests/system/loopback.xml")
    set(lock domain_${domain})
  endif()
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}_properties.cmake)
  file(CONFIGURE OUTPUT ${script} @ONLY CONTENT [=[
set(name [[@name@]])
set(cases ${@name@_test_TESTS})
set(program [[@CMAKE_BINARY_DIR@/tests/@name@_test]])
set(is_nightly [[@ARG_NIGHTLY@]])
set(nightly_cases [[@ARG_NIGHTLY_CASES@]])
set(alone_cases [[@ARG_ALONE_CASES@]])
set(environment [[@environment@]])
set(lock [[@lock@]])
include([[@PROJECT_SOURCE_DIR@/cmake/test_properties.cmake]])
]=])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()
