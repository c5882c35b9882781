#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    pybind11 2.10.3 (Debian 12, pybind11-dev 2.10.3-1), integer vectors of Eigen 3.4.0
# Behaviour  An argument of type Eigen::VectorXi accepts arrays of any numbers and texts, and casts
#            them as C does: 1.9 becomes 1, 2**40 + 7 becomes 7, "3" becomes 3. No exception is
#            raised. Of overloads for VectorXi and VectorXd, the list [1.9, 2.9] takes the first.
# Expected   int and std::vector<int> as arguments raise TypeError for 1.9, 2**40 + 7 and "3". The
#            manual describes copies of matrices for another storage or element type, and no
#            change of their values.
# Matters    Numbers of nodes or frames that were computed, or read from a table, are cut off or
#            wrapped without a word: another node is taken.
# Needs      g++, python3 of Debian 12 with its headers, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install pybind11-dev=2.10.3-1 libeigen3-dev=3.4.0-4 \
  python3-numpy=1:1.24.2-1+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas
export PYTHONPATH=$PWD:$PWD/unpacked/usr/lib/python3/dist-packages OMP_NUM_THREADS=1

cat >numbers_.cpp <<'CPP'
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

using Numbers = std::vector<int>;

Numbers Copy(const Eigen::VectorXi& values) {
  return {values.data(), values.data() + values.size()};
}

PYBIND11_MODULE(numbers_, module) {
  module.attr("pybind11") = std::to_string(PYBIND11_VERSION_MAJOR) + "." +
                            std::to_string(PYBIND11_VERSION_MINOR);
  module.def("vector_of_int", [](const Numbers& values) { return values; });
  module.def("VectorXi", &Copy);
  module.def("VectorXi_noconvert", &Copy, pybind11::arg("values").noconvert());
  module.def("overloaded", [](const Eigen::VectorXi&) { return "VectorXi"; });
  module.def("overloaded", [](const Eigen::VectorXd&) { return "VectorXd"; });
}
CPP
g++ -std=c++17 -O0 -shared -fPIC -I/usr/include/python3.11 -isystem unpacked/usr/include \
  -isystem unpacked/usr/include/eigen3 numbers_.cpp -o numbers_.so

cat >try.py <<'PY'
import numbers_
import numpy

print("pybind11", numbers_.pybind11)
for values in ([1.9, 2.9], numpy.array([1.9, 2.9]), numpy.array([2**40 + 7]), ["3", "4"]):
    print(type(values).__name__, list(values))
    for name in ("vector_of_int", "VectorXi", "VectorXi_noconvert", "overloaded"):
        try:
            print(f"  {name}: {getattr(numbers_, name)(values)}")
        except TypeError:
            print(f"  {name}: TypeError")
PY

/usr/bin/python3 try.py | tee seen

cat >expected <<'SEEN'
pybind11 2.10
list [1.9, 2.9]
  vector_of_int: TypeError
  VectorXi: [1, 2]
  VectorXi_noconvert: TypeError
  overloaded: VectorXi
ndarray [1.9, 2.9]
  vector_of_int: TypeError
  VectorXi: [1, 2]
  VectorXi_noconvert: TypeError
  overloaded: VectorXd
ndarray [1099511627783]
  vector_of_int: TypeError
  VectorXi: [7]
  VectorXi_noconvert: TypeError
  overloaded: VectorXi
list ['3', '4']
  vector_of_int: TypeError
  VectorXi: [3, 4]
  VectorXi_noconvert: TypeError
  overloaded: VectorXi
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
