# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# palpate_ipopt: the interior-point solver Ipopt (coinor-libipopt-dev). Only libipopt itself
# is linked: pkg-config also lists its own BLAS and LAPACK, and programs of ours have one BLAS.
find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(IPOPT QUIET ipopt)
endif()
find_library(IPOPT_LIBRARY ipopt HINTS ${IPOPT_LIBRARY_DIRS})
find_path(IPOPT_INCLUDE_DIR IpTNLP.hpp HINTS ${IPOPT_INCLUDE_DIRS} PATH_SUFFIXES coin coin-or)
if(NOT IPOPT_LIBRARY OR NOT IPOPT_INCLUDE_DIR)
  message(FATAL_ERROR "Ipopt is not installed: apt install coinor-libipopt-dev")
endif()
add_library(palpate_ipopt INTERFACE)
target_include_directories(palpate_ipopt SYSTEM INTERFACE ${IPOPT_INCLUDE_DIR})
# Ipopt 3.11's headers include <cstddef> only if HAVE_CSTDDEF is defined.
target_compile_definitions(palpate_ipopt INTERFACE HAVE_CSTDDEF)
target_link_libraries(palpate_ipopt INTERFACE ${IPOPT_LIBRARY})
