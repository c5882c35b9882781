#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTK 9.1.0 (Debian 12, python3-vtk9), faces of vtkPlatonicSolidSource
# Behaviour  Of its five solids two are inside out. All faces of the tetrahedron and of the
#            icosahedron turn inwards, those of cube, octahedron and dodecahedron outwards. So
#            vtkImplicitPolyDataDistance calls the centre of an icosahedron outside.
# Expected   All solids of one source turn their faces outwards, as vtkSphereSource does. Its
#            documentation names the centre and the size only.
# Matters    An icosahedron is the usual start of a sphere of equal triangles. As a probe or a test
#            body it is pushed from the wrong side, and distances have the wrong sign.
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

cat >solids.py <<'PY'
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkCommonDataModel import vtkTriangle
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource, vtkSphereSource


def report(name, source):
    """Of a body around the origin: how many faces turn their normal away from it."""
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    triangles.Update()
    surface = triangles.GetOutput()
    outwards = 0
    for number in range(surface.GetNumberOfCells()):
        corners = [surface.GetCell(number).GetPoints().GetPoint(k) for k in range(3)]
        normal = [0.0] * 3
        vtkTriangle.ComputeNormal(*corners, normal)
        outwards += sum(a * b for a, b in zip(normal, corners[0])) > 0
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(surface)
    side = "inside" if distance.EvaluateFunction((0, 0, 0)) < 0 else "outside"
    print(f"{name:12s} {outwards:2d} of {surface.GetNumberOfCells():2d} triangles outwards, "
          f"the centre is {side}")


print("VTK", vtkVersion().GetVTKVersion())
for solid in ("Tetrahedron", "Cube", "Octahedron", "Icosahedron", "Dodecahedron"):
    source = vtkPlatonicSolidSource()
    getattr(source, f"SetSolidTypeTo{solid}")()
    report(solid, source)
report("Sphere", vtkSphereSource())
PY

/usr/bin/python3 solids.py | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
Tetrahedron   0 of  4 triangles outwards, the centre is outside
Cube         12 of 12 triangles outwards, the centre is inside
Octahedron    8 of  8 triangles outwards, the centre is inside
Icosahedron   0 of 20 triangles outwards, the centre is outside
Dodecahedron 36 of 36 triangles outwards, the centre is inside
Sphere       96 of 96 triangles outwards, the centre is inside
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
