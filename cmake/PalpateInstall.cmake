# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# What goes where. Component programs: what a user runs, with its files. Component development:
# libraries, headers and the CMake package palpate. An installed tree may be moved: programs find
# their files relative to their own folder (libs/app/project_files.hpp).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Neither ninja install nor cpack builds what was not asked for: ninja programs manuals does.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(files_folder ${CMAKE_INSTALL_DATADIR}/palpate)

# Programs and the files that they read
install(TARGETS palpate ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        COMPONENT programs)
install(DIRECTORY config/ DESTINATION ${files_folder}/config COMPONENT programs
        FILES_MATCHING PATTERN "*.yaml" PATTERN "*.msh" PATTERN "*.xml" PATTERN "*.json"
        PATTERN systemd EXCLUDE)
# palpate demo --recording beam plays it.
install(DIRECTORY tests/data/beam_calculix DESTINATION ${files_folder}/tests/data
        COMPONENT programs PATTERN "*.py" EXCLUDE)

# Manual pages and completions, which the target manuals writes
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR}
        COMPONENT programs OPTIONAL)
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}
        COMPONENT programs OPTIONAL)
install(CODE [[
  file(GLOB pages "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/man/man1/palpate*.1")
  if(pages)
    execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
  endif()
]] COMPONENT programs)

# Units of systemd, which name the folder of the programs; and their settings, in /etc where the
# prefix is /usr (also that of a package being made, which ends in /usr).
file(GLOB units ${PROJECT_SOURCE_DIR}/config/systemd/*.service
     ${PROJECT_SOURCE_DIR}/config/systemd/*.target)
file(GLOB unit_settings ${PROJECT_SOURCE_DIR}/config/systemd/*.env)
install(CODE "set(units [[${units}]])\nset(unit_settings [[${unit_settings}]])\n
set(drop_ins [[${PROJECT_SOURCE_DIR}/config/systemd/palpate@capture.service.d]])"
        COMPONENT programs)
install(CODE [[
  set(prefix "${CMAKE_INSTALL_PREFIX}")
  set(staged_etc "${prefix}/etc")
  set(etc "${staged_etc}")
  if(prefix MATCHES "^(.*)/usr$")
    set(prefix /usr)
    set(staged_etc "${CMAKE_MATCH_1}/etc")
    set(etc /etc)
  endif()
  set(folder "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/systemd/system")
  foreach(unit IN LISTS units)
    cmake_path(GET unit FILENAME name)
    configure_file("${unit}" "${folder}/${name}.new" @ONLY)
    file(RENAME "${folder}/${name}.new" "${folder}/${name}")
    file(CHMOD "${folder}/${name}" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    message(STATUS "Installing: ${folder}/${name}")
  endforeach()
  # file(INSTALL) itself puts DESTDIR in front.
  file(INSTALL ${drop_ins} DESTINATION "${CMAKE_INSTALL_PREFIX}/lib/systemd/system")
  file(INSTALL ${unit_settings} DESTINATION "${staged_etc}/palpate")
]] COMPONENT programs)

# Libraries and headers. A program that links them includes "libs/fem/elastic_body.hpp". Component
# engine: finite elements and robots alone, which need neither DDS nor YAML, with the headers that
# their public ones reach. Component development: all the rest.
include(PalpateEngine)
set(header_folder ${CMAKE_INSTALL_INCLUDEDIR}/palpate)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
get_property(libraries GLOBAL PROPERTY PALPATE_LIBRARIES)
list(REMOVE_ITEM libraries palpate)
foreach(library IN LISTS libraries)
  set_target_properties(palpate_${library} PROPERTIES EXPORT_NAME ${library})
  if(library IN_LIST PALPATE_ENGINE_LIBRARIES)
    list(APPEND engine_targets palpate_${library})
  else()
    list(APPEND targets palpate_${library})
  endif()
endforeach()
install(TARGETS ${engine_targets} palpate_suitesparse EXPORT palpate_engine_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT engine
        INCLUDES DESTINATION ${header_folder})
install(TARGETS ${targets} palpate_ipopt EXPORT palpate_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        INCLUDES DESTINATION ${header_folder})
install(EXPORT palpate_engine_targets NAMESPACE palpate:: FILE palpate-engine-targets.cmake
        DESTINATION ${package_folder} COMPONENT engine)
install(EXPORT palpate_targets NAMESPACE palpate:: FILE palpate-targets.cmake
        DESTINATION ${package_folder} COMPONENT development)
palpate_engine_headers(engine_headers)
foreach(header IN LISTS engine_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${header_folder}/${folder} COMPONENT engine)
  string(REPLACE "." "\\." pattern ${header})
  list(APPEND without_engine REGEX "/${pattern}$" EXCLUDE)
endforeach()
install(DIRECTORY libs components DESTINATION ${header_folder} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp" PATTERN node EXCLUDE PATTERN components/palpate EXCLUDE
        ${without_engine})
install(DIRECTORY ${CMAKE_BINARY_DIR}/idl/ DESTINATION ${header_folder} COMPONENT development
        FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp" PATTERN CMakeFiles EXCLUDE)
install(FILES idl/message_traits.hpp DESTINATION ${header_folder}/idl COMPONENT development)
# For ROS 2: the messages as a package of their own.
install(DIRECTORY idl/palpate_msgs DESTINATION ${files_folder}/idl COMPONENT development)

configure_package_config_file(cmake/palpate-config.cmake.in
  ${CMAKE_BINARY_DIR}/palpate-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/palpate-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/palpate-config.cmake
              ${CMAKE_BINARY_DIR}/palpate-config-version.cmake
        DESTINATION ${package_folder} COMPONENT engine)
