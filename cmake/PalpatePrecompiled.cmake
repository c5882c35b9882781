# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Precompiled Eigen (and, for tests, GoogleTest): parsing them is a third of the time of a typical
# source. Off by default, on in the presets of optimised builds; off in debug and tidy, so that a
# header which forgets an include is found.
option(PALPATE_PCH "Precompile Eigen and GoogleTest" OFF)
if(NOT PALPATE_PCH)
  return()
endif()

# GCC takes a precompiled header only where the code model is the same: programs, tests and the
# libraries of programs alone share the compiler's own default, and the libraries of the Python
# module (PalpateTargets.cmake) have a header of their own.
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)

# ccache caches precompiled headers only with a sloppiness that ignores changes of macros.
if(PALPATE_CCACHE)
  set(launcher env CCACHE_SLOPPINESS=pch_defines,time_macros ${PALPATE_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

# palpate_add_precompiled(NAME LIBS target... HEADERS header...): for REUSE_FROM of other targets.
function(palpate_add_precompiled name)
  cmake_parse_arguments(ARG "" "" "LIBS;HEADERS" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Holds the precompiled header of ${name}.\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} palpate_warnings)
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

set(common_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <filesystem> <functional> <string>
    <vector>)
palpate_add_precompiled(palpate_pch LIBS Eigen3::Eigen HEADERS ${common_headers})
palpate_add_precompiled(palpate_module_pch LIBS Eigen3::Eigen HEADERS ${common_headers})
palpate_position_independent(palpate_module_pch)
if(PALPATE_BUILD_TESTS)
  palpate_add_precompiled(palpate_test_pch LIBS Eigen3::Eigen GTest::gmock GTest::gtest
                          HEADERS ${common_headers} <gmock/gmock.h> <gtest/gtest.h>)
  target_compile_options(palpate_test_pch PRIVATE ${PALPATE_TEST_OPTIONS})
endif()
