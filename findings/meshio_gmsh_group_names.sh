#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    meshio 7.0.0-3 of Debian 12 (python3-meshio) with files of Gmsh 4.8.4, names of groups
# Behaviour  A physical surface and a physical volume of one name are two groups for Gmsh, which
#            keeps names for each dimension. meshio keeps one: the surface's triangles are read, but
#            its group has none of them, and field_data has the number of the volume. There is no
#            error and no warning. With two different names both groups are there.
# Expected   Both groups are kept, or the second one is refused.
# Matters    A body "tip" with a boundary "tip", on which loads act, arrives without its boundary.
#            Which of the two is left depends on the order of the names in the file.
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
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas OMP_NUM_THREADS=1
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

# named SURFACE VOLUME: a box whose groups have these names.
named() {
  cat >body.geo <<GEO
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
MeshSize {:} = 1;
Physical Surface("$1", 5) = {1};
Physical Volume("$2", 9) = {1};
GEO
  unpacked/usr/bin/gmsh -3 -format msh41 -o body.msh body.geo >log 2>&1
  echo "Gmsh:"
  sed -n '/PhysicalNames/,/EndPhysicalNames/p' body.msh | sed '1,2d;$d; s/^/  /'
  echo "meshio:"
  /usr/bin/python3 read.py
}

cat >read.py <<'PY'
import meshio

mesh = meshio.read("body.msh", file_format="gmsh")
print("  cells:", ", ".join(f"some {block.type}" for block in mesh.cells if len(block.data)))
for name, (number, dimension) in sorted(mesh.field_data.items()):
    print(f"  field_data {name}: number {number}, dimension {dimension}")
for name, parts in sorted(mesh.cell_sets.items()):
    if not name.startswith("gmsh:"):
        kinds = [block.type for block, part in zip(mesh.cells, parts) if len(part)]
        print(f"  cell_sets {name}: {', '.join(kinds)}")
PY

{
  unpacked/usr/bin/gmsh -version 2>&1
  named base body
  named tip tip
} 2>&1 | tee seen

cat >expected <<'SEEN'
4.8.4
Gmsh:
  2 5 "base"
  3 9 "body"
meshio:
  cells: some triangle, some tetra
  field_data base: number 5, dimension 2
  field_data body: number 9, dimension 3
  cell_sets base: triangle
  cell_sets body: tetra
Gmsh:
  2 5 "tip"
  3 9 "tip"
meshio:
  cells: some triangle, some tetra
  field_data tip: number 9, dimension 3
  cell_sets tip: tetra
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
