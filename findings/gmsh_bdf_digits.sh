#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Gmsh 4.8.4 (Debian 12, gmsh 4.8.4+ds2-3), coordinates in a Nastran file (.bdf)
# Behaviour  A coordinate is printed and then cut off after eight characters, not rounded. Zeros
#            behind the point and the sign count: 0.0123456789 becomes 0.012346, and
#            -0.0123456789 becomes -0.01234. Of -0.00123456789 three digits are left. The free
#            format (Mesh.BdfFieldFormat=0), whose fields have no width, is cut off in the same
#            way. Only the format of 16 characters (=2) keeps all digits. Gmsh gives no warning.
# Expected   Rounded values with the digits that eight characters hold: -.012346 or -1.2346-2. In
#            the free format all digits, as in Gmsh's other formats of text.
# Matters    In metres a robot of some centimetres is moved to a grid of 10 micrometres. What was
#            symmetric is not: opposite nodes differ by 6 micrometres.
# Needs      apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The program, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install gmsh=4.8.4+ds2-3 libgmsh4.8=4.8.4+ds2-3 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas OMP_NUM_THREADS=1
gmsh=$PWD/unpacked/usr/bin/gmsh

# One tetrahedron around the plane x = 0.
cat >body.msh <<'MSH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0.0123456789 0.0098765432 0.00123456789
2 -0.0123456789 0.0098765432 0.00123456789
3 0 -0.0098765432 0.00123456789
4 0 0 -0.00123456789
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
MSH

# save FORMAT OPTIONS: the mesh in that format, with the number of warnings and errors.
save() {
  local status=0 format=$1
  shift
  "$gmsh" -save -format "$format" "$@" -o out body.msh >log 2>&1 || status=$?
  echo "$format $*: exit $status, $(grep -c -E 'Warning|Error' log || true) warnings and errors"
}

{
  "$gmsh" -version 2>&1
  save bdf
  grep GRID out | sed 's/^/  /; s/ *$//'
  save bdf -setnumber Mesh.BdfFieldFormat 0
  grep GRID out | sed 's/^/  /; s/ *$//'
  save bdf -setnumber Mesh.BdfFieldFormat 2
  grep -A 1 GRID out | sed 's/^/  /; s/ *$//'
  save inp
  sed -n '/NODE/,/^4/p' out | sed 's/^/  /; s/ *$//'
} | tee seen

cat >expected <<'SEEN'
4.8.4
bdf : exit 0, 0 warnings and errors
  GRID    1       0       0.0123460.0098770.001235
  GRID    2       0       -0.012340.0098770.001235
  GRID    3       0       0.00E+00-0.009870.001235
  GRID    4       0       0.00E+000.00E+00-0.00123
bdf -setnumber Mesh.BdfFieldFormat 0: exit 0, 0 warnings and errors
  GRID,1,0,0.012346,0.009877,0.001235
  GRID,2,0,-0.01234,0.009877,0.001235
  GRID,3,0,0.00E+00,-0.00987,0.001235
  GRID,4,0,0.00E+00,0.00E+00,-0.00123
bdf -setnumber Mesh.BdfFieldFormat 2: exit 0, 0 warnings and errors
  GRID*   1               0               0.0123456789    0.0098765432
  *       0.00123456789
  GRID*   2               0               -0.0123456789   0.0098765432
  *       0.00123456789
  GRID*   3               0               0               -0.0098765432
  *       0.00123456789
  GRID*   4               0               0               0
  *       -0.00123456789
inp : exit 0, 0 warnings and errors
  *NODE
  1, 0.0123456789, 0.0098765432, 0.00123456789
  2, -0.0123456789, 0.0098765432, 0.00123456789
  3, 0, -0.0098765432, 0.00123456789
  4, 0, 0, -0.00123456789
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
