# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# The three shapes a folder of this project can have: a library, a component, a folder of tests.
include(GoogleTest)

# palpate_add_library(NAME [LIBS lib...] [PUBLIC target...] [PRIVATE target...] [EXCLUDE regex...])
# The sources of this folder and its subfolders as target palpate::NAME.
# LIBS are libraries of this project; PUBLIC third-party targets that our headers show, PRIVATE
# those that no header of ours shows; EXCLUDE leaves out sources whose path matches.
function(palpate_add_library name)
  cmake_parse_arguments(ARG "" "" "LIBS;PUBLIC;PRIVATE;EXCLUDE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  foreach(pattern IN LISTS ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${pattern})
  endforeach()
  list(TRANSFORM ARG_LIBS PREPEND palpate::)
  if(sources)
    add_library(palpate_${name} STATIC ${sources})
    target_include_directories(palpate_${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(palpate_${name} PUBLIC ${ARG_LIBS} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    palpate_own_code(palpate_${name})
  else()
    add_library(palpate_${name} INTERFACE)
    target_include_directories(palpate_${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(palpate_${name} INTERFACE ${ARG_LIBS} ${ARG_PUBLIC})
  endif()
  add_library(palpate::${name} ALIAS palpate_${name})
endfunction()

# add_component(NAME [LIBS lib...] [PUBLIC target...] [PRIVATE target...] [NODE_LIBS lib...])
# Three targets: palpate::NAME (algorithm, no DDS), palpate::NAME_node (wiring, a library so that
# tests can start it in their own process), and the program palpate-NAME (node/main.cpp).
function(add_component name)
  cmake_parse_arguments(ARG "" "" "LIBS;PUBLIC;PRIVATE;NODE_LIBS" ${ARGN})
  palpate_add_library(${name} LIBS ${ARG_LIBS} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE}
                      EXCLUDE "/node/" "/main\\.cpp$")
  if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/node/main.cpp)
    return()
  endif()
  file(GLOB node_sources CONFIGURE_DEPENDS node/*.cpp)
  list(FILTER node_sources EXCLUDE REGEX "/main\\.cpp$")
  list(TRANSFORM ARG_NODE_LIBS PREPEND palpate::)
  add_library(palpate_${name}_node STATIC ${node_sources})
  target_link_libraries(palpate_${name}_node
    PUBLIC palpate::${name} palpate::dds palpate::app palpate::idl ${ARG_NODE_LIBS})
  palpate_own_code(palpate_${name}_node)
  add_library(palpate::${name}_node ALIAS palpate_${name}_node)
  string(REPLACE "_" "-" program palpate-${name})
  add_executable(${program} node/main.cpp)
  target_link_libraries(${program} PRIVATE palpate::${name}_node)
  palpate_own_code(${program})
  set_property(GLOBAL APPEND PROPERTY PALPATE_PROGRAMS ${program})
endfunction()

# palpate_use_loopback(NAME): the cases of test program NAME get a DDS domain id of their own, on
# 127.0.0.1 only. gtest_discover_tests cannot pass a list (ENVIRONMENT), so that a script which
# ctest reads after the discovery sets it.
function(palpate_use_loopback name)
  get_property(domain GLOBAL PROPERTY PALPATE_NEXT_TEST_DOMAIN)
  if(NOT domain)
    set(domain 20)
  endif()
  math(EXPR next "${domain} + 1")
  set_property(GLOBAL PROPERTY PALPATE_NEXT_TEST_DOMAIN ${next})
  set(uri "file://${PROJECT_SOURCE_DIR}/tests/system/loopback.xml")
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}_loopback.cmake)
  file(CONFIGURE OUTPUT ${script} @ONLY CONTENT [=[
if(@name@_test_TESTS)
  set_tests_properties(${@name@_test_TESTS} PROPERTIES
    ENVIRONMENT "ROS_DOMAIN_ID=@domain@;CYCLONEDDS_URI=@uri@"
    RESOURCE_LOCK domain_@domain@ LABELS loopback)
endif()
]=])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()

# add_component_test(NAME [LIBS lib...] [PRIVATE target...] [LOOPBACK] [ALONE] [TIMEOUT seconds])
# One test program from the sources of this folder, each of its cases a test of ctest, named
# NAME.Suite.Case. LOOPBACK: DDS on 127.0.0.1 only, a domain id of its own, so that tests run in
# parallel and meet nobody. ALONE: nothing else runs beside, for processes that keep a rate.
function(add_component_test name)
  cmake_parse_arguments(ARG "LOOPBACK;ALONE" "TIMEOUT" "LIBS;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  if(NOT sources)
    return()
  endif()
  list(TRANSFORM ARG_LIBS PREPEND palpate::)
  add_executable(${name}_test ${sources})
  target_link_libraries(${name}_test PRIVATE ${ARG_LIBS} ${ARG_PRIVATE} GTest::gmock
                        GTest::gtest_main)
  palpate_own_code(${name}_test PCH palpate_test_pch)
  target_compile_definitions(${name}_test PRIVATE
    PALPATE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PALPATE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  set_target_properties(${name}_test PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_ALONE})
  if(ARG_LOOPBACK)
    palpate_use_loopback(${name})
  endif()
endfunction()
