#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    CalculiX 2.20 (Debian 12, calculix-ccx 2.20-1), sets whose parts overlap
# Behaviour  A set of two sets with a common node has this node twice. *CLOAD then puts twice the
#            force on it, and the printed total of reactions counts it twice. An element that is
#            twice in a set bears twice the pressure and has twice its volume in the total. Its
#            weight (GRAV) counts once. There is no warning, and the exit code is 0.
# Expected   A set has each of its members once, whatever the load, as it is for the weight.
# Matters    Two edges of a tip share a corner, two regions of a body share a layer: the union of
#            their sets is the natural way to load both. The load is then too large at some nodes,
#            and the sum of the reactions, by which one checks it, can be too large as well.
# Needs      apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The program, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install calculix-ccx=2.20-1 libspooles2.2=2.2-14 libarpack2=3.8.0-3 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" root; done
libraries=root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$PWD/$libraries:$PWD/$libraries/lapack:$PWD/$libraries/blas
export OMP_NUM_THREADS=1

# solve TITLE SETS LOADS OUTPUT: a cube of edge 1 on a fixed base.
solve() {
  cat >job.inp <<INP
*NODE
1, 0.0, 0.0, 0.0
2, 1.0, 0.0, 0.0
3, 1.0, 1.0, 0.0
4, 0.0, 1.0, 0.0
5, 0.0, 0.0, 1.0
6, 1.0, 0.0, 1.0
7, 1.0, 1.0, 1.0
8, 0.0, 1.0, 1.0
*ELEMENT, TYPE=C3D8, ELSET=BODY
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=BASE
1, 2, 3, 4
*NSET, NSET=FRONT
5, 6
*NSET, NSET=RIGHT
6, 7
*ELSET, ELSET=LAYER
1
$2
*MATERIAL, NAME=SILICONE
*ELASTIC
1000.0, 0.0
*DENSITY
1.0
*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE
*BOUNDARY
BASE, 1, 3
*STEP
*STATIC
$3
$4
*END STEP
INP
  status=0
  root/usr/bin/ccx -i job >log 2>&1 || status=$?
  echo "$1: exit code $status, $(grep -ciE 'warning|error' log || true) warnings"
  awk '/total/ {title = $0; sub(/ for set/, " of set", title); sub(/ and time.*/, "", title)}
       title != "" && !/total/ && NF {printf " %s: %.3f\n", title, $NF; title = ""}' job.dat
}

reactions='*NODE PRINT, NSET=BASE, TOTALS=ONLY
RF'
three=$'*NSET, NSET=TIP\n5, 6, 7'
union=$'*NSET, NSET=TIP\nFRONT, RIGHT'
twice=$'*ELSET, ELSET=ALL\nBODY, LAYER'
{
  dpkg-deb -f debs/calculix-ccx_*.deb Version
  solve "force 1 on nodes 5, 6, 7" "$three" $'*CLOAD\nTIP, 3, 1.0' "$reactions"
  solve "force 1 on FRONT and RIGHT" "$union" $'*CLOAD\nTIP, 3, 1.0' "$reactions"
  solve "nodes 5, 6, 7 raised by 0.1" "$three" $'*BOUNDARY\nTIP, 3, 3, 0.1' \
    "$reactions"$'\n*NODE PRINT, NSET=TIP, TOTALS=ONLY\nRF'
  solve "FRONT and RIGHT raised by 0.1" "$union" $'*BOUNDARY\nTIP, 3, 3, 0.1' \
    "$reactions"$'\n*NODE PRINT, NSET=TIP, TOTALS=ONLY\nRF'
  solve "pressure 1 on BODY" "" $'*DLOAD\nBODY, P2, 1.0' "$reactions"
  solve "pressure 1 on BODY and LAYER" "$twice" $'*DLOAD\nALL, P2, 1.0' \
    "$reactions"$'\n*EL PRINT, ELSET=ALL, TOTALS=ONLY\nEVOL'
  solve "gravity 1 on BODY" "" $'*DLOAD\nBODY, GRAV, 1.0, 0.0, 0.0, -1.0' "$reactions"
  solve "gravity 1 on BODY and LAYER" "$twice" $'*DLOAD\nALL, GRAV, 1.0, 0.0, 0.0, -1.0' \
    "$reactions"
} | tee seen

cat >expected <<'SEEN'
2.20-1
force 1 on nodes 5, 6, 7: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: -3.000
force 1 on FRONT and RIGHT: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: -4.000
nodes 5, 6, 7 raised by 0.1: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: -60.294
  total force (fx,fy,fz) of set TIP: 60.294
FRONT and RIGHT raised by 0.1: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: -60.294
  total force (fx,fy,fz) of set TIP: 80.147
pressure 1 on BODY: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: 1.000
pressure 1 on BODY and LAYER: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: 2.000
  total volume of set ALL: 2.000
gravity 1 on BODY: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: 0.500
gravity 1 on BODY and LAYER: exit code 0, 0 warnings
  total force (fx,fy,fz) of set BASE: 0.500
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
