#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTK 9.1.0 (Debian 12, python3-vtk9), infinity in a .vtu file of the form ASCII
# Behaviour  VTK writes NaN as nan and infinity as inf. It reads nan, but not inf: of the whole file
#            nothing is left, neither points nor cells, nor the arrays before it. A message goes to
#            the terminal. Update() raises nothing, and GetErrorCode() stays 0. In the binary and
#            appended forms the same grid is read back as it was.
# Expected   VTK reads what it wrote, infinity as well as NaN, in each of its three forms.
# Matters    One infinite value (a ratio with a force of 0, an unbounded standard error) loses the
#            whole mesh. A program goes on with 0 points.
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

cat >values.py <<'PY'
import math

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter


def grid_with(value):
    grid, points = vtkUnstructuredGrid(), vtkPoints()
    for node in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        points.InsertNextPoint(node)
    grid.SetPoints(points)
    grid.InsertNextCell(VTK_TETRA, 4, [0, 1, 2, 3])
    for name, values in (("first", [1, 2, 3, 4]), ("second", [1, 2, 3, value])):
        array = vtkDoubleArray()
        array.SetName(name)
        for number in values:
            array.InsertNextValue(number)
        grid.GetPointData().AddArray(array)
    return grid


def read(name):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
    values = [[array.GetValue(k) for k in range(array.GetNumberOfTuples())] for array in arrays]
    return (f"code {reader.GetErrorCode()}, {grid.GetNumberOfPoints()} points, "
            f"{grid.GetNumberOfCells()} cells, {values}")


print("VTK", vtkVersion().GetVTKVersion())
for value in (4.0, math.nan, math.inf):
    for form in ("Ascii", "Binary", "Appended"):
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid_with(value))
        writer.SetFileName("grid.vtu")
        getattr(writer, f"SetDataModeTo{form}")()
        written = writer.Write()
        print(f"{value} {form}: wrote {written}, read {read('grid.vtu')}")
PY

/usr/bin/python3 values.py 2>errors | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
4.0 Ascii: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]]
4.0 Binary: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]]
4.0 Appended: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]]
nan Ascii: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, nan]]
nan Binary: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, nan]]
nan Appended: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, nan]]
inf Ascii: wrote 1, read code 0, 0 points, 0 cells, []
inf Binary: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, inf]]
inf Appended: wrote 1, read code 0, 4 points, 1 cells, [[1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, inf]]
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
