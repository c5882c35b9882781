#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Netgen 6.2.2006 (Debian 12, python3-netgen) and Gmsh 4.8.4: .msh files of Netgen
# Behaviour  Netgen's "Gmsh Format" and "Gmsh2 Format" hold every tetrahedron inside out. Gmsh
#            reads them without a warning, and its Jacobian determinants are negative: the unit
#            cube has the volume -1. The same mesh as "Abaqus Format" has positive volumes.
# Expected   In Gmsh's manual nodes 0 to 3 are at the origin and at 1 on the axes u, v and w, as in
#            Abaqus. Netgen turns its own order into that of Abaqus, and so into that of Gmsh.
# Matters    A solver that takes det J from the node order has a negative stiffness and negative
#            weights. One that swaps two corners, but no nodes at edges, tangles quadratic elements.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-netgen=6.2.2006+really6.2.1905+dfsg-5.1+b1 \
  libnglib-6.2=6.2.2006+really6.2.1905+dfsg-5.1+b1 python3-gmsh=4.8.4+ds2-3 \
  libgmsh4.8=4.8.4+ds2-3 python3-numpy=1:1.24.2-1+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
modules=$PWD/unpacked/usr/lib/python3/dist-packages
ln -s "$libraries/libgmsh.so.4.8" "$modules/libgmsh.so"
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas PYTHONPATH=$modules
export OMP_NUM_THREADS=1

cat >generate.py <<'PY'
from netgen.csg import CSGeometry, OrthoBrick, Pnt

geometry = CSGeometry()
geometry.Add(OrthoBrick(Pnt(0, 0, 0), Pnt(1, 1, 1)))
mesh = geometry.GenerateMesh(maxh=0.6)
mesh.Export("one.msh", "Gmsh Format")
mesh.Export("two.msh", "Gmsh2 Format")
mesh.Export("linear.inp", "Abaqus Format")
mesh.SecondOrder()
mesh.Export("quadratic.msh", "Gmsh2 Format")
PY

cat >volumes.py <<'PY'
import gmsh
import numpy


def report(name, volumes):
    print(f"{name:18s} {'over 10' if len(volumes) > 10 else 'few'} tetrahedra, "
          f"all positive: {bool((volumes > 0).all())}, all negative: {bool((volumes < 0).all())}, "
          f"sum {volumes.sum():.6f}")


def of_corners(points, tetrahedra):
    edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
    return numpy.linalg.det(edges) / 6


def read_with_gmsh(name):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    gmsh.open(name)
    warnings = [line for line in gmsh.logger.get() if not line.startswith("Info")]
    gmsh.logger.stop()
    for kind in gmsh.model.mesh.getElementTypes(3):
        places, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss1")
        _, determinants, _ = gmsh.model.mesh.getJacobians(kind, places)
        report(name, determinants * weights[0])
        print(f"{'':18s} {gmsh.model.mesh.getElementProperties(kind)[0]}, "
              f"{len(warnings)} warnings of Gmsh")
    gmsh.finalize()


def read_abaqus(name):
    section, points, tetrahedra = "", [], []
    for line in open(name):
        if line.startswith("*"):
            section = line.lower()
        elif section.startswith("*node"):
            points.append([float(word) for word in line.split(",")[1:4]])
        elif section.startswith("*element") and "c3d4" in section:
            tetrahedra.append([int(word) - 1 for word in line.split(",")[1:5]])
    report(name, of_corners(numpy.array(points), numpy.array(tetrahedra)))


for file in ("one.msh", "two.msh", "quadratic.msh"):
    read_with_gmsh(file)
read_abaqus("linear.inp")
PY

if ! /usr/bin/python3 generate.py >generate.log 2>&1; then
  cat generate.log >&2
  exit 1
fi
{
  dpkg-deb -f debs/python3-netgen_*.deb Version
  /usr/bin/python3 volumes.py
} | tee seen

cat >expected <<'SEEN'
6.2.2006+really6.2.1905+dfsg-5.1+b1
one.msh            over 10 tetrahedra, all positive: False, all negative: True, sum -1.000000
                   Tetrahedron 4, 0 warnings of Gmsh
two.msh            over 10 tetrahedra, all positive: False, all negative: True, sum -1.000000
                   Tetrahedron 4, 0 warnings of Gmsh
quadratic.msh      over 10 tetrahedra, all positive: False, all negative: True, sum -1.000000
                   Tetrahedron 10, 0 warnings of Gmsh
linear.inp         over 10 tetrahedra, all positive: True, all negative: False, sum 1.000000
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
