# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# The Debian packages palpate, palpate-engine-dev and palpate-dev, made by cpack from the install
# rules. ./run package builds what they hold and then calls cpack.
set(control_folder ${PROJECT_SOURCE_DIR}/cmake/debian)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CONTACT "The palpate authors <palpate@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL programs engine development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME palpate)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS bash-completion)
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "forces on soft robots from images
A depth camera or motion capture measures a cable-driven soft robot, and a
finite-element model follows it. The deformation gives the location and size
of every contact, with a 95 % interval.
.
The package holds the command palpate, the processes on Cyclone DDS, which
ROS 2 sees as nodes, and units of systemd for these.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA
    ${control_folder}/postinst ${control_folder}/prerm ${control_folder}/postrm
    ${CMAKE_BINARY_DIR}/debian/conffiles)

set(CPACK_DEBIAN_ENGINE_PACKAGE_NAME palpate-engine-dev)
set(CPACK_DEBIAN_ENGINE_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_ENGINE_PACKAGE_DEPENDS "libeigen3-dev, libsuitesparse-dev, libopenblas-dev, \
libtinyxml2-dev, zlib1g-dev, liblzma-dev, liblz4-dev, pkg-config")
set(CPACK_DEBIAN_ENGINE_DESCRIPTION "finite-element models of soft robots - development files
Meshes, static equilibria, compliances and sensitivities of cable-driven soft
robots: the libraries fem and robot of palpate, their headers, and a CMake
package. They need neither DDS nor a settings file.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME palpate-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "palpate-engine-dev (= ${PROJECT_VERSION}), \
libyaml-cpp-dev, libcli11-dev, libspdlog-dev, libfmt-dev, nlohmann-json3-dev, libssl-dev, \
libpng-dev, libjpeg62-turbo-dev, libzstd-dev, libdeflate-dev, libsqlite3-dev, \
cyclonedds-dev, libaravis-dev, libpcl-dev, coinor-libipopt-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS palpate)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "forces on soft robots from images - development files
The libraries of palpate (finite elements, robots, cameras, recordings, DDS)
and the algorithms of its components, their headers, a CMake package, and the
messages palpate_msgs as a package of ROS 2.")

# Every file in /etc is the administrator's once it is there.
foreach(file IN LISTS unit_settings)
  cmake_path(GET file FILENAME name)
  string(APPEND conffiles "/etc/palpate/${name}\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/debian/conffiles CONTENT "${conffiles}")

# copyright and changelog of all packages
foreach(package programs:palpate engine:palpate-engine-dev development:palpate-dev)
  string(REPLACE ":" ";" package ${package})
  list(GET package 0 component)
  list(GET package 1 name)
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${name})
  install(FILES ${control_folder}/copyright DESTINATION ${documents} COMPONENT ${component})
  install(CODE "set(documents [[${documents}]])
set(package [[${name} (${PROJECT_VERSION})]])
set(version [[${PROJECT_VERSION}]])
set(contact [[${CPACK_PACKAGE_CONTACT}]])" COMPONENT ${component})
  install(CODE [[
    string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
    set(changelog "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${documents}/changelog")
    file(WRITE "${changelog}" "${package} bookworm; urgency=medium

  * Version ${version}: see CHANGELOG.md in the sources.

 -- ${contact}  ${date}
")
    execute_process(COMMAND gzip -9nf "${changelog}" COMMAND_ERROR_IS_FATAL ANY)
  ]] COMPONENT ${component})
endforeach()

include(CPack)
