#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Gmsh 4.8.4 (Debian 12, python3-gmsh 4.8.4+ds2-3), meshing after a caught exception
# Behaviour  Once any call has raised an exception, setOrder() returns without an effect, and
#            refine() deletes all tetrahedra. Neither raises, nor logs an error or a warning. The
#            exception can be that of a picture without a window, or of an unknown volume.
#            A successful write() does not end this, generate() does.
# Expected   A refused call leaves the mesh and later calls as they were, once its exception is
#            caught.
# Matters    A script draws its mesh if there is a window, or asks whether a volume exists. Then it
#            saves linear elements for quadratic ones, or a .msh file without any tetrahedron.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The library, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-gmsh=4.8.4+ds2-3 libgmsh4.8=4.8.4+ds2-3 \
  python3-numpy=1:1.24.2-1+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
modules=$PWD/unpacked/usr/lib/python3/dist-packages
ln -s "$libraries/libgmsh.so.4.8" "$modules/libgmsh.so"
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas PYTHONPATH=$modules
export OMP_NUM_THREADS=1

cat >mesh.py <<'PY'
import gmsh

kUnknownVolume = 77


def kinds():
    types, _, nodes = gmsh.model.mesh.getElements(3)
    counts = []
    for kind, numbers in zip(types, nodes):
        name, _, _, size, _, _ = gmsh.model.mesh.getElementProperties(kind)
        counts.append(f"{'over' if len(numbers) // size > 500 else 'up to'} 500 {name}")
    return ", ".join(counts) or "no tetrahedra"


def step(name, function):
    gmsh.logger.start()
    try:
        function()
        outcome = "done"
    except Exception as error:
        outcome = f'"{str(error)[:40]}"'
    logged = [line for line in gmsh.logger.get() if line.startswith(("Error", "Warning"))]
    gmsh.logger.stop()
    print(f"  {name}: {outcome}, {len(logged)} logged, {kinds()}")


def session(name, refused):
    print(name)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.5)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    step("generate", lambda: gmsh.model.mesh.generate(3))
    if refused:
        step("refused", refused)
    step("write", lambda: gmsh.write("good.msh"))
    step("setOrder 2", lambda: gmsh.model.mesh.setOrder(2))
    step("setOrder 1", lambda: gmsh.model.mesh.setOrder(1))
    step("refine", gmsh.model.mesh.refine)
    step("write", lambda: gmsh.write("good.msh"))
    step("generate", lambda: gmsh.model.mesh.generate(3))
    step("setOrder 2", lambda: gmsh.model.mesh.setOrder(2))
    gmsh.clear()
    gmsh.open("good.msh")
    print(f"  the file: {kinds()}")
    gmsh.finalize()


gmsh.initialize()
print("Gmsh", gmsh.option.getString("General.Version"))
gmsh.finalize()
session("no exception", None)
session("a picture", lambda: gmsh.write("a.png"))
session("an unknown volume", lambda: gmsh.model.getBoundingBox(3, kUnknownVolume))
PY

/usr/bin/python3 mesh.py 2>&1 | tee seen

cat >expected <<'SEEN'
Gmsh 4.8.4
no exception
  generate: done, 0 logged, up to 500 Tetrahedron 4
  write: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 2: done, 0 logged, up to 500 Tetrahedron 10
  setOrder 1: done, 0 logged, up to 500 Tetrahedron 4
  refine: done, 0 logged, over 500 Tetrahedron 4
  write: done, 0 logged, over 500 Tetrahedron 4
  generate: done, 0 logged, over 500 Tetrahedron 4
  setOrder 2: done, 0 logged, over 500 Tetrahedron 10
  the file: over 500 Tetrahedron 4
a picture
  generate: done, 0 logged, up to 500 Tetrahedron 4
  refused: "Creating 'a.png' requires a graphical in", 1 logged, up to 500 Tetrahedron 4
  write: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 2: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 1: done, 0 logged, up to 500 Tetrahedron 4
  refine: done, 0 logged, no tetrahedra
  write: done, 0 logged, no tetrahedra
  generate: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 2: done, 0 logged, up to 500 Tetrahedron 10
  the file: no tetrahedra
an unknown volume
  generate: done, 0 logged, up to 500 Tetrahedron 4
  refused: "Volume 77 does not exist", 1 logged, up to 500 Tetrahedron 4
  write: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 2: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 1: done, 0 logged, up to 500 Tetrahedron 4
  refine: done, 0 logged, no tetrahedra
  write: done, 0 logged, no tetrahedra
  generate: done, 0 logged, up to 500 Tetrahedron 4
  setOrder 2: done, 0 logged, up to 500 Tetrahedron 10
  the file: no tetrahedra
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
