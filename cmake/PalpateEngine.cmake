# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# The engine: what of libs/ a program needs that has neither DDS nor settings files of ours, and
# the headers that it may include (docs/library). Whoever takes one out breaks such programs.
set(PALPATE_ENGINE_LIBRARIES core linalg geometry fem robot)
set(engine_entry_headers
  libs/core/error.hpp
  libs/core/status.hpp
  libs/fem/boundary_surface.hpp
  libs/fem/cell_stress.hpp
  libs/fem/elastic_body.hpp
  libs/fem/embedding.hpp
  libs/fem/linearisation.hpp
  libs/fem/material.hpp
  libs/fem/mesh_io/read_mesh.hpp
  libs/fem/mesh_io/write_vtu.hpp
  libs/fem/mesh_report.hpp
  libs/fem/static_solver.hpp
  libs/fem/surface_patch.hpp
  libs/fem/tet_mesh.hpp
  libs/robot/compliance.hpp
  libs/robot/robot_body.hpp
  libs/robot/robot_description.hpp
  libs/robot/robot_model.hpp
  libs/robot/sensitivity/parameters.hpp
  libs/robot/sensitivity/point_sensitivity.hpp
  libs/robot/sensitivity/sensitivity_solver.hpp)

# palpate_engine_headers(OUT): these, and all that they include.
function(palpate_engine_headers out)
  set(waiting ${engine_entry_headers})
  set(found "")
  while(waiting)
    list(POP_FRONT waiting header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"libs/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" included "${line}")
      list(APPEND waiting ${included})
    endforeach()
  endwhile()
  list(SORT found)
  set(${out} ${found} PARENT_SCOPE)
endfunction()
