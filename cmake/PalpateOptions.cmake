# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Language level, warnings, sanitizers, clang-tidy, output folders and ccache, for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(PALPATE_CCACHE ccache)
if(PALPATE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER ${PALPATE_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PALPATE_CCACHE})
endif()

# Ten sources of a target at a time in one run of the compiler, some sixteen of a test program: most
# of a source's time goes into the headers and templates that its neighbours use, too. On in the
# presets of optimised builds, where tests/style/check_includes.py finds what a source forgets to
# include; off in debug and tidy.
option(PALPATE_UNITY "Compile many sources of a target at a time" OFF)

# -Wno-restrict, -Wno-stringop-overflow: GCC 12 warns without cause inside std::string's operator+
# (GCC bug 105651). What the optimiser guesses about bounds and initialisation depends on what it
# inlines, so it warns but never stops a build. The same holds for a name that shadows one of
# another source of its unit; in the debug preset a unit is one source.
add_library(palpate_warnings INTERFACE)
target_compile_options(palpate_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Woverloaded-virtual -Wdouble-promotion
  $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow>
  $<$<BOOL:${PALPATE_WERROR}>:-Werror>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-error=array-bounds>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-error=stringop-overread>
  $<$<BOOL:${PALPATE_UNITY}>:-Wno-error=shadow>)

set(PALPATE_SANITIZE "" CACHE STRING "Sanitizers, as the compiler names them (address,undefined)")
if(PALPATE_SANITIZE)
  add_compile_options(-fsanitize=${PALPATE_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PALPATE_SANITIZE})
endif()

# Each function has a section of its own, and a program keeps those that it calls.
add_compile_options(-ffunction-sections -fdata-sections)
add_link_options(-Wl,--gc-sections)

# GCC collects garbage less often, which trades some 0.5 GB of memory for processor time.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-expand=200>"
                      "$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-heapsize=524288>")
endif()

# clang-tidy beside the compiler, for our own targets only (palpate_add_library and its kin turn
# it on); generated code never sees it.
if(PALPATE_TIDY)
  find_program(PALPATE_CLANG_TIDY NAMES clang-tidy REQUIRED)
endif()

# Sources of tests are compiled with less optimisation than what they test: a quarter of their time.
set(PALPATE_TEST_OPTIONS "$<$<CONFIG:Release>:-O1>")

# palpate_even_batches(OUT COUNT WANTED): the batch size near WANTED that leaves of COUNT sources no
# small rest.
function(palpate_even_batches out count wanted)
  math(EXPR batches "(${count} + ${wanted} / 2) / ${wanted}")
  if(batches LESS 1)
    set(batches 1)
  endif()
  math(EXPR batch "(${count} + ${batches} - 1) / ${batches}")
  set(${out} ${batch} PARENT_SCOPE)
endfunction()

# palpate_position_independent(TARGET): for code that becomes part of a shared object.
function(palpate_position_independent target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON
                        CXX_VISIBILITY_PRESET hidden)
endfunction()

# palpate_own_code(TARGET [PCH name]): the warnings, the precompiled header where there is one, and,
# in the tidy preset, clang-tidy.
function(palpate_own_code target)
  cmake_parse_arguments(ARG "" "PCH" "" ${ARGN})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:palpate_warnings>)
  if(NOT ARG_PCH)
    set(ARG_PCH palpate_pch)
  endif()
  if(PALPATE_PCH)
    target_precompile_headers(${target} REUSE_FROM ${ARG_PCH})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
  if(ARG_PCH STREQUAL palpate_test_pch)
    target_compile_options(${target} PRIVATE ${PALPATE_TEST_OPTIONS})
  endif()
  if(PALPATE_UNITY)
    set(batch 10)
    if(ARG_PCH STREQUAL palpate_test_pch)
      get_target_property(sources ${target} SOURCES)
      list(LENGTH sources count)
      palpate_even_batches(batch ${count} 16)
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
  if(PALPATE_TIDY)
    set_target_properties(${target} PROPERTIES CXX_CLANG_TIDY
      "${PALPATE_CLANG_TIDY};--quiet;--extra-arg=-Wno-unknown-warning-option")
  endif()
endfunction()
