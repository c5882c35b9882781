# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# The two shapes a folder of this project can have: a library or a component.

# What the Python module links, a shared object: position-independent in every build, so that
# programs and module have the same objects and give the same bits. Names are hidden outside of the
# object, so that calls between functions of ours stay direct and cost programs nothing.
set(PALPATE_MODULE_LIBRARIES core linalg app geometry fem robot rgbd correspondence experiment
    recording calibration force_estimation perception offline)

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
    target_include_directories(palpate_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
    target_link_libraries(palpate_${name} PUBLIC ${ARG_LIBS} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    if(name IN_LIST PALPATE_MODULE_LIBRARIES)
      palpate_position_independent(palpate_${name})
      palpate_own_code(palpate_${name} PCH palpate_module_pch)
    else()
      palpate_own_code(palpate_${name})
    endif()
  else()
    add_library(palpate_${name} INTERFACE)
    target_include_directories(palpate_${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
    target_link_libraries(palpate_${name} INTERFACE ${ARG_LIBS} ${ARG_PUBLIC})
  endif()
  add_library(palpate::${name} ALIAS palpate_${name})
  set_property(GLOBAL APPEND PROPERTY PALPATE_LIBRARIES ${name})
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
