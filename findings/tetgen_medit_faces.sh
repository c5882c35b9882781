#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    TetGen 1.5.0 (Debian 12, tetgen 1.5.0-5), Medit .mesh files of the option -g
# Behaviour  "Triangles" holds all faces of all tetrahedra, also those inside the body, with the
#            reference 0: 18 for a unit cube, whose .face file of the same run has 12. Of elements
#            of second order (-o2) the .ele file has ten nodes. The .mesh has all vertices, but
#            tetrahedra of four, so that the nodes at edges belong to nothing. The exit code is 0.
# Expected   Triangles of a Medit file are the boundary, as Gmsh writes them: faces inside have an
#            option of their own, -f. A vertex belongs to an element.
# Matters    Who takes the triangles as the surface gets walls through the body. Nodes without an
#            element make a stiffness matrix singular, and quadratic elements are linear ones.
# Needs      apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The program, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install tetgen=1.5.0-5 libtet1.5=1.5.0-5 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
export LD_LIBRARY_PATH=$PWD/unpacked/usr/lib/x86_64-linux-gnu

# The unit cube, with the marker 1 on its sides.
cat >cube.poly <<'POLY'
8 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
6 1
1 0 1
4 1 2 3 4
1 0 1
4 5 6 7 8
1 0 1
4 1 2 6 5
1 0 1
4 2 3 7 6
1 0 1
4 3 4 8 7
1 0 1
4 4 1 5 8
0
0
POLY

# Of the points x, the area of a triangle.
cat >area.awk <<'AWK'
function Area(a, b, c,   k, u, v, n) {
  for (k = 0; k < 3; ++k) {
    u[k] = x[b, k] - x[a, k]
    v[k] = x[c, k] - x[a, k]
  }
  for (k = 0; k < 3; ++k) {
    n += (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])^2
  }
  return sqrt(n) / 2
}
AWK

# The .node file, then the .face file: each begins with a line of sizes.
cat >face.awk <<'AWK'
FNR == 1 || /^#/ { next }
FILENAME ~ /node$/ {
  for (k = 0; k < 3; ++k) x[$1, k] = $(k + 2)
  next
}
{
  ++count
  area += Area($2, $3, $4)
}
END { printf "  .face: %d triangles, area %.3f\n", count, area }
AWK

cat >medit.awk <<'AWK'
/^#/ || NF == 0 { next }
/^[A-Z]/ {
  section = $1
  if (section ~ /^(Vertices|Triangles|Tetrahedra)$/) getline
  next
}
section == "Vertices" {
  ++vertices
  for (k = 0; k < 3; ++k) x[vertices, k] = $(k + 1)
}
section == "Triangles" {
  ++triangles
  area += Area($1, $2, $3)
}
section == "Tetrahedra" {
  ++tetrahedra
  nodes = NF - 1
  for (k = 1; k <= nodes; ++k) used[$k] = 1
}
END {
  for (node in used) ++count
  printf "  .mesh: %d triangles, area %.3f\n", triangles, area
  printf "  .mesh: %d tetrahedra of %d nodes, %d of %d vertices in none\n", tetrahedra, nodes,
         vertices - count, vertices
}
AWK

# shown OPTIONS: what the files of a run hold.
shown() {
  local status=0
  rm -f cube.1.*
  unpacked/usr/bin/tetgen "$1" cube.poly >log 2>&1 || status=$?
  echo "tetgen $1: exit $status"
  awk -f area.awk -f face.awk cube.1.node cube.1.face
  awk 'NR == 1 { printf "  .ele: %d tetrahedra of %d nodes\n", $1, $2 }' cube.1.ele
  awk -f area.awk -f medit.awk cube.1.mesh
}

{
  dpkg-deb -f debs/tetgen_*.deb Version
  shown -pg
  shown -pgo2
} | tee seen

cat >expected <<'SEEN'
1.5.0-5
tetgen -pg: exit 0
  .face: 12 triangles, area 6.000
  .ele: 6 tetrahedra of 4 nodes
  .mesh: 18 triangles, area 10.402
  .mesh: 6 tetrahedra of 4 nodes, 0 of 8 vertices in none
tetgen -pgo2: exit 0
  .face: 12 triangles, area 6.000
  .ele: 6 tetrahedra of 10 nodes
  .mesh: 18 triangles, area 10.402
  .mesh: 6 tetrahedra of 4 nodes, 19 of 27 vertices in none
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
