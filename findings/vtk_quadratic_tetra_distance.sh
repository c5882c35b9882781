#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTK 9.1.0 (Debian 12, python3-vtk9), closest points of ten-node tetrahedra
# Behaviour  vtkQuadraticTetra::EvaluatePosition() limits each of three parametric coordinates to
#            0 to 1, but not their sum. For a point beyond the face opposite to node 0 it returns
#            0 (outside), the point itself as the closest one, and the distance 0. So
#            vtkCellLocator::FindClosestPoint() finds a distance of 0 for points far outside.
#            vtkTetra is exact.
# Expected   vtkCell's documentation: of a point outside, the closest point lies on the cell, and
#            the distance is the one between them. So both tetrahedra here give the same.
# Matters    Where measured points are compared with a quadratic mesh, distances are too small, and
#            points far outside seem to lie exactly on the surface.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The library, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
  libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

cat >distance.py <<'PY'
import math

from vtkmodules.vtkCommonCore import reference, vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import (VTK_QUADRATIC_TETRA, VTK_TETRA, vtkCellLocator,
                                           vtkGenericCell, vtkUnstructuredGrid)

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
# Straight edges: both cells are the same body.
NODES = CORNERS + [tuple((a + b) / 2 for a, b in zip(CORNERS[i], CORNERS[k])) for i, k in EDGES]


def body(kind, count):
    grid, points = vtkUnstructuredGrid(), vtkPoints()
    for node in NODES[:count]:
        points.InsertNextPoint(node)
    grid.SetPoints(points)
    grid.InsertNextCell(kind, count, list(range(count)))
    return grid


def evaluated(grid, x):
    closest, part, parametric, squared = [0.0] * 3, reference(0), [0.0] * 3, reference(0.0)
    cell = grid.GetCell(0)
    side = cell.EvaluatePosition(x, closest, part, parametric, squared, [0.0] * 10)
    return side, closest, math.sqrt(squared)


def located(grid, x):
    locator = vtkCellLocator()
    locator.SetDataSet(grid)
    locator.BuildLocator()
    closest, part, number, squared = [0.0] * 3, reference(0), reference(0), reference(0.0)
    locator.FindClosestPoint(x, closest, vtkGenericCell(), number, part, squared)
    return math.sqrt(squared)


print("VTK", vtkVersion().GetVTKVersion())
linear, quadratic = body(VTK_TETRA, 4), body(VTK_QUADRATIC_TETRA, 10)
for x in [(0.2, 0.2, 0.2), (0.5, 0.5, 0.5), (0.9, 0.9, 0.9), (1.5, 0.2, 0.2), (-0.5, 0.2, 0.2)]:
    print("point", x)
    for name, grid in (("vtkTetra", linear), ("vtkQuadraticTetra", quadratic)):
        side, closest, distance = evaluated(grid, x)
        print(f"  {name:17s} {'inside' if side else 'outside'}, closest "
              f"({', '.join(f'{value:.3f}' for value in closest)}), distance {distance:.3f}, "
              f"of the locator {located(grid, x):.3f}")
PY

/usr/bin/python3 distance.py | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
point (0.2, 0.2, 0.2)
  vtkTetra          inside, closest (0.200, 0.200, 0.200), distance 0.000, of the locator 0.000
  vtkQuadraticTetra inside, closest (0.200, 0.200, 0.200), distance 0.000, of the locator 0.000
point (0.5, 0.5, 0.5)
  vtkTetra          outside, closest (0.333, 0.333, 0.333), distance 0.289, of the locator 0.289
  vtkQuadraticTetra outside, closest (0.500, 0.500, 0.500), distance 0.000, of the locator 0.000
point (0.9, 0.9, 0.9)
  vtkTetra          outside, closest (0.333, 0.333, 0.333), distance 0.981, of the locator 0.981
  vtkQuadraticTetra outside, closest (0.900, 0.900, 0.900), distance 0.000, of the locator 0.000
point (1.5, 0.2, 0.2)
  vtkTetra          outside, closest (1.000, 0.000, 0.000), distance 0.574, of the locator 0.574
  vtkQuadraticTetra outside, closest (1.000, 0.200, 0.200), distance 0.500, of the locator 0.500
point (-0.5, 0.2, 0.2)
  vtkTetra          outside, closest (0.000, 0.200, 0.200), distance 0.500, of the locator 0.500
  vtkQuadraticTetra outside, closest (0.000, 0.200, 0.200), distance 0.500, of the locator 0.500
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
