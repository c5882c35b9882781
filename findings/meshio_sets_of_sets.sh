#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    meshio 7.0.0-3 of Debian 12 (python3-meshio), sets of Abaqus decks that name other sets
# Behaviour  A *NSET that lists names of sets is read as an empty set. One of names and numbers has
#            the numbers alone. Of an *ELSET the first name in each line counts, and beside numbers
#            none. There is no error and no warning. CalculiX 2.20 takes the same deck with all
#            nodes and elements.
# Expected   Both kinds of sets may list earlier sets, in Abaqus as in CalculiX. meshio knows such
#            element sets, as it refuses a name that it did not read.
# Matters    Fixed nodes that are the union of two sets arrive as no node at all. A material of
#            several regions arrives at the first of them.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The programs, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-meshio=7.0.0-3 python3-rich=13.3.1-1 \
  python3-numpy=1:1.24.2-1+deb12u1 calculix-ccx=2.20-1 libspooles2.2=2.2-14 \
  libarpack2=3.8.0-3 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas OMP_NUM_THREADS=1
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

# Two tetrahedra. ccx prints the nodes and the elements of each set.
cat >job.inp <<'INP'
*NODE
1, 0.0, 0.0, 0.0
2, 1.0, 0.0, 0.0
3, 0.0, 1.0, 0.0
4, 0.0, 0.0, 1.0
5, 1.0, 1.0, 1.0
*ELEMENT, TYPE=C3D4, ELSET=BODY
1, 1, 2, 3, 4
2, 2, 3, 4, 5
*NSET, NSET=LEFT
1, 3
*NSET, NSET=RIGHT
2
*NSET, NSET=NAMES
LEFT, RIGHT
*NSET, NSET=MIXED
LEFT
2, 4
*ELSET, ELSET=LOWER
1
*ELSET, ELSET=UPPER
2
*ELSET, ELSET=UNION
LOWER, UPPER
*ELSET, ELSET=BESIDE
LOWER
2
*MATERIAL, NAME=SILICONE
*ELASTIC
1.0e5, 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE
*BOUNDARY
NAMES, 1, 3
*STEP
*STATIC
*CLOAD
5, 3, 0.001
*NODE PRINT, NSET=NAMES
U
*NODE PRINT, NSET=MIXED
U
*EL PRINT, ELSET=UNION
EVOL
*EL PRINT, ELSET=BESIDE
EVOL
*END STEP
INP

cat >sets.py <<'PY'
import meshio

mesh = meshio.read("job.inp")
for name in ("NAMES", "MIXED"):
    print(f"  {name}: nodes {' '.join(str(node + 1) for node in mesh.point_sets[name])}".rstrip())


def flat(items):
    for item in items:
        if hasattr(item, "__len__"):
            yield from flat(item)
        else:
            yield item


for name in ("UNION", "BESIDE"):
    elements = " ".join(str(cell + 1) for cell in flat(mesh.cell_sets[name]))
    print(f"  {name}: elements {elements}".rstrip())
PY

{
  unpacked/usr/bin/ccx -v | grep -o 'Version.*' || true
  status=0
  unpacked/usr/bin/ccx -i job >log 2>&1 || status=$?
  awk '/ for set / {
         for (k = 1; k < NF; ++k) if ($k == "set") name = $(k + 1)
         printf "%s  %s: %s", count++ ? "\n" : "", name, /displacements/ ? "nodes" : "elements"
         next
       }
       NF { printf " %s", $1 }
       END { print "" }' job.dat
  echo "exit $status"
  echo "python3-meshio $(dpkg-deb -f debs/python3-meshio_*.deb Version)"
  /usr/bin/python3 sets.py
} 2>&1 | tee seen

cat >expected <<'SEEN'
Version 2.20
  NAMES: nodes 1 3 2
  MIXED: nodes 1 3 2 4
  UNION: elements 1 2
  BESIDE: elements 1 2
exit 0
python3-meshio 7.0.0-3
  NAMES: nodes
  MIXED: nodes 2 4
  UNION: elements 1
  BESIDE: elements 2
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
