# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Every third-party package, found once. All of them are packages of Debian 12.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
set(PALPATE_CYCLONEDDS "" CACHE PATH
    "Where another Cyclone DDS 0.10 is installed, its idlc too (docs/security.md); empty: Debian's")
if(PALPATE_CYCLONEDDS)
  list(PREPEND CMAKE_PREFIX_PATH ${PALPATE_CYCLONEDDS})
  list(APPEND CMAKE_INSTALL_RPATH ${PALPATE_CYCLONEDDS}/lib)
endif()
find_package(CycloneDDS 0.10 REQUIRED)
# Certificates and signatures of a secured domain.
find_package(OpenSSL 3 REQUIRED COMPONENTS Crypto)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tinyxml2 REQUIRED CONFIG)
# Beast: HTTP and WebSocket of the live page.
find_package(Boost 1.74 REQUIRED)

find_package(PkgConfig REQUIRED)
# Compression of recordings.
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(LZMA REQUIRED IMPORTED_TARGET liblzma)
pkg_check_modules(LIBDEFLATE REQUIRED IMPORTED_TARGET libdeflate)
# Recordings of rosbag2 in its storage sqlite3.
pkg_check_modules(SQLITE3 REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(ARAVIS REQUIRED IMPORTED_TARGET aravis-0.8)
# Of PCL the one library that needs no other; components/perception compiles the rest that it uses.
# FLANN, whose headers PCL's search trees use, refers to lz4.
pkg_check_modules(PCL REQUIRED pcl_segmentation)
set(PCL_LIBRARIES pcl_common PkgConfig::LZ4)

# One vendor, so that timings and rounding do not depend on what else a machine has.
set(BLA_VENDOR OpenBLAS)
find_package(BLAS REQUIRED)

find_path(SUITESPARSE_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(SUITESPARSECONFIG_LIBRARY suitesparseconfig REQUIRED)
add_library(palpate_suitesparse INTERFACE)
target_include_directories(palpate_suitesparse SYSTEM INTERFACE ${SUITESPARSE_INCLUDE_DIR})
target_link_libraries(palpate_suitesparse INTERFACE ${CHOLMOD_LIBRARY}
                      ${SUITESPARSECONFIG_LIBRARY} BLAS::BLAS)

# Whoever only builds programs needs no more. Tests and benchmarks are left out where their packages
# are missing; a later configuration finds what has been installed since.
find_path(PALPATE_GMOCK_HEADER gmock/gmock.h)
if(PALPATE_BUILD_TESTS AND PALPATE_GMOCK_HEADER)
  find_package(GTest QUIET)
  find_package(embree 3 QUIET)
endif()
if(NOT TARGET GTest::gmock OR NOT TARGET embree)
  message(STATUS "No tests: they need GoogleTest with gmock, and Embree 3")
  set(PALPATE_BUILD_TESTS OFF)
endif()
if(PALPATE_BUILD_BENCHMARKS)
  find_package(benchmark QUIET)
endif()
if(NOT TARGET benchmark::benchmark OR NOT PALPATE_BUILD_TESTS)
  message(STATUS "No benchmarks: they need Google Benchmark, and all that the tests need")
  set(PALPATE_BUILD_BENCHMARKS OFF)
endif()

# The Python module of Debian's python, left out where its packages are missing.
if(PALPATE_BUILD_PYTHON)
  set(Python_FIND_STRATEGY LOCATION)
  set(Python_ROOT_DIR /usr)
  find_package(Python 3.11 QUIET COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
if(NOT TARGET Python::NumPy OR NOT TARGET pybind11::headers)
  message(STATUS "No Python module: it needs pybind11-dev, python3-dev and python3-numpy")
  set(PALPATE_BUILD_PYTHON OFF)
endif()
