#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTK 9.1.0 (Debian 12, python3-vtk9), sign of vtkImplicitPolyDataDistance
# Behaviour  vtkPolyDataNormals repeats the points of sharp edges, one for each side. On a cone that
#            went through it, vtkImplicitPolyDataDistance gives points outside a negative distance.
#            They lie up to 1.5 from this cone of height 2. There is no warning. On the cone as it
#            was, and with its points merged again, all signs are right.
# Expected   Both surfaces are the same triangles in the same places. The class documents negative
#            distances inside, positive ones outside, by an angle-weighted normal of edges.
# Matters    A scan or a CAD body that got normals for drawing tests points far outside as inside
#            where its edges are sharper than 90 degrees. With a box nothing is noticed.
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

cat >sign.py <<'PY'
import itertools
import math

from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkFiltersCore import (vtkCleanPolyData, vtkImplicitPolyDataDistance,
                                       vtkPolyDataNormals, vtkTriangleFilter)
from vtkmodules.vtkFiltersSources import vtkConeSource, vtkCubeSource

STEPS = [-1.45 + 0.1 * k for k in range(30)]


def through(filter_, surface):
    filter_.SetInputData(surface)
    filter_.Update()
    return filter_.GetOutput()


def cone():
    source = vtkConeSource()
    source.SetHeight(2)
    source.SetRadius(0.5)
    source.SetResolution(64)
    source.Update()
    return source.GetOutput(), lambda x: abs(x[0]) < 1 and math.hypot(*x[1:]) < (1 - x[0]) / 4


def cube():
    source = vtkCubeSource()
    source.Update()
    return through(vtkCleanPolyData(), source.GetOutput()), lambda x: max(map(abs, x)) < 0.5


def report(name, surface, is_inside):
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(surface)
    values = [(x, distance.EvaluateFunction(x)) for x in itertools.product(STEPS, STEPS, STEPS)]
    wrong = [abs(value) for x, value in values if (value < 0) != is_inside(x)]
    print(f"  {name}: {surface.GetNumberOfPoints()} points, "
          f"{'over 500' if len(wrong) > 500 else len(wrong)} wrong signs of {len(values)}, "
          f"the farthest {'over 1' if wrong and max(wrong) > 1 else 'none'}")


print("VTK", vtkVersion().GetVTKVersion())
for name, (surface, is_inside) in (("cube", cube()), ("cone", cone())):
    print(name)
    triangles = through(vtkTriangleFilter(), surface)
    split = through(vtkPolyDataNormals(), triangles)
    report("as it is", triangles, is_inside)
    report("with normals", split, is_inside)
    report("merged again", through(vtkCleanPolyData(), split), is_inside)
PY

/usr/bin/python3 sign.py | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
cube
  as it is: 8 points, 0 wrong signs of 27000, the farthest none
  with normals: 24 points, 0 wrong signs of 27000, the farthest none
  merged again: 8 points, 0 wrong signs of 27000, the farthest none
cone
  as it is: 65 points, 0 wrong signs of 27000, the farthest none
  with normals: 129 points, over 500 wrong signs of 27000, the farthest over 1
  merged again: 65 points, 0 wrong signs of 27000, the farthest none
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
