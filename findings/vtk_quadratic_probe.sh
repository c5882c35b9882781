#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTK 9.1.0 (Debian 12, python3-vtk9), vtkProbeFilter in cells of second order
# Behaviour  The coordinate x is stored at the points of a cell with straight edges and read at
#            points inside. In a quadratic tetrahedron it is wrong by up to 1e-5 of the cell's size,
#            in a quadratic hexahedron by 1e-4, in a quadratic wedge or pyramid by 1e-3. Linear
#            cells and the triquadratic hexahedron of the same shape give it to rounding.
# Expected   All these cells reproduce linear fields, and the map of a straight cell to its
#            parametric coordinates is linear: one step of Newton's method is exact. Instead, the
#            search halves its error in each step, and ends at a tolerance.
# Matters    Differences of probed displacements are strains. Over a hundredth of a cell, 1e-3 of
#            its size is 10 % strain in an undeformed body. A finer mesh of the same cells does not
#            help, as the error is relative to the cell.
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

cat >probe.py <<'PY'
import random

from vtkmodules import vtkCommonDataModel
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkDoubleArray, vtkPoints, vtkVersion
from vtkmodules.vtkFiltersCore import vtkProbeFilter


def points_at(places):
    points = vtkPoints()
    points.SetDataType(VTK_DOUBLE)
    for place in places:
        points.InsertNextPoint(place)
    return points


def placed(r):
    return (r[0] + 0.1 * r[2], 0.2 * r[0] + 1.1 * r[1], 0.1 * r[0] + 0.3 * r[1] + 0.9 * r[2])


def worst_error(name):
    cell = getattr(vtkCommonDataModel, "vtk" + name)()
    count = cell.GetNumberOfPoints()
    corners = cell.GetParametricCoords()
    mesh = vtkCommonDataModel.vtkUnstructuredGrid()
    mesh.SetPoints(points_at(placed(corners[3 * k:3 * k + 3]) for k in range(count)))
    mesh.InsertNextCell(cell.GetCellType(), count, list(range(count)))
    field = vtkDoubleArray()
    field.SetName("x")
    for k in range(count):
        field.InsertNextValue(mesh.GetPoint(k)[0])
    mesh.GetPointData().SetScalars(field)

    # Points inside a tetrahedron with three edges of the unit cube, which is part of all the cells.
    shares = [sorted(random.random() for _ in range(3)) for _ in range(300)]
    asked = [placed((a, b - a, 0.9 * (c - b))) for a, b, c in shares]
    data = vtkCommonDataModel.vtkPolyData()
    data.SetPoints(points_at(asked))
    probe = vtkProbeFilter()
    probe.SetInputData(data)
    probe.SetSourceData(mesh)
    probe.Update()
    found = probe.GetOutput().GetPointData().GetArray("x")
    valid = probe.GetOutput().GetPointData().GetArray("vtkValidPointMask")
    assert all(valid.GetValue(k) for k in range(len(asked))), name
    return max(abs(found.GetValue(k) - x) for k, (x, _, _) in enumerate(asked))


random.seed(1)
print("VTK", vtkVersion().GetVTKVersion())
for name in ("Tetra", "QuadraticTetra", "Hexahedron", "QuadraticHexahedron",
             "TriQuadraticHexahedron", "Wedge", "QuadraticWedge", "Pyramid", "QuadraticPyramid"):
    error = worst_error(name)
    print(f"vtk{name}: error of x", "below 1e-14" if error < 1e-14 else f"up to {error:.0e}")
PY

/usr/bin/python3 probe.py | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
vtkTetra: error of x below 1e-14
vtkQuadraticTetra: error of x up to 1e-05
vtkHexahedron: error of x below 1e-14
vtkQuadraticHexahedron: error of x up to 1e-04
vtkTriQuadraticHexahedron: error of x below 1e-14
vtkWedge: error of x below 1e-14
vtkQuadraticWedge: error of x up to 1e-03
vtkPyramid: error of x below 1e-14
vtkQuadraticPyramid: error of x up to 1e-03
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
