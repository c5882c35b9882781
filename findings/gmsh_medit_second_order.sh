#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Gmsh 4.8.4 (Debian 12, gmsh 4.8.4+ds2-3), second-order tetrahedra in a Medit .mesh
# Behaviour  Gmsh writes tetrahedra of ten nodes below the keyword "Tetrahedra", which announces
#            four nodes and a reference: eleven numbers a line instead of five. It reads its file
#            back as a mesh of four-node tetrahedra, without a warning. meshio refuses the file.
#            A reader that takes numbers in sequence gets other tetrahedra.
# Expected   Medit files are a sequence of numbers: the keyword alone says how many belong to an
#            element. "TetrahedraP2" is the keyword for ten nodes. Or a mesh that the format does
#            not hold is refused, and Gmsh reads back what it wrote.
# Matters    A quadratic mesh comes back linear, and much too stiff in bending. With other readers
#            nodes at edges become corners of tetrahedra, and groups get their numbers.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The programs, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install gmsh=4.8.4+ds2-3 libgmsh4.8=4.8.4+ds2-3 python3-meshio=7.0.0-3 \
  python3-rich=13.3.1-1 python3-numpy=1:1.24.2-1+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages OMP_NUM_THREADS=1
gmsh=$PWD/unpacked/usr/bin/gmsh

# One tetrahedron with the nodes 1 to 4 at its corners and 5 to 10 at its edges, in the group 9.
cat >body.msh <<'MSH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 9 "body"
$EndPhysicalNames
$Nodes
10
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0.5 0 0
6 0.5 0.5 0
7 0 0.5 0
8 0 0 0.5
9 0 0.5 0.5
10 0.5 0 0.5
$EndNodes
$Elements
1
1 11 2 9 9 1 2 3 4 5 6 7 8 9 10
$EndElements
MSH

# contents FILE: nodes and tetrahedra of a .msh file of version 2 (types 4 and 11 of Gmsh).
contents() {
  awk '/^\$Nodes/ { getline; nodes = $1 }
       /^\$Elements/ { inside = 1 }
       inside && $2 == 4 { linear++ }
       inside && $2 == 11 { quadratic++ }
       END {
         printf "%d nodes, tetrahedra: %d of 4 nodes, %d of 10\n", nodes, linear, quadratic
       }' "$1"
}

# convert IN OUT: by Gmsh, with its exit code and the number of its warnings and errors.
convert() {
  local status=0
  "$gmsh" -save -format "${2##*.}" -o "$2" "$1" >log 2>&1 || status=$?
  echo "$1 to $2: exit $status, $(grep -c -E 'Warning|Error' log || true) warnings and errors"
}

{
  "$gmsh" -version 2>&1
  contents body.msh
  convert body.msh out.mesh
  sed -n '/Tetrahedra/,/End/p' out.mesh | sed 's/^ *//; s/ *$//; s/^/  /'
  convert out.mesh back.msh2
  contents back.msh2
  /usr/bin/python3 - <<'PY'
import contextlib
import io

import meshio

try:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        meshio.read("out.mesh")
    print("meshio reads it")
except (Exception, SystemExit):
    print(f"meshio {meshio.__version__} refuses out.mesh")
PY
} | tee seen

cat >expected <<'SEEN'
4.8.4
10 nodes, tetrahedra: 0 of 4 nodes, 1 of 10
body.msh to out.mesh: exit 0, 0 warnings and errors
  Tetrahedra
  1
  1 2 3 4 5 6 7 8 10 9 9
  End
out.mesh to back.msh2: exit 0, 0 warnings and errors
4 nodes, tetrahedra: 1 of 4 nodes, 0 of 10
meshio 5.0.0 refuses out.mesh
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
