#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    VTKLoader of three.js 0.187.0 (npm) and legacy files of VTK 9.1.0 (python3-vtk9)
# Behaviour  VTK 9 writes .vtk files of version 5.1, with an array of offsets and one of point
#            numbers. The loader reads the ASCII form as if it were version 4.2, without an error:
#            16 triangles become 60, with point numbers that the file does not have. On the binary
#            form it throws an error about an array of negative length. After SetFileVersion(42)
#            of the writer it reads both.
# Expected   The first line of the file names the version: the loader reads it, or refuses it.
# Matters    A surface that is saved with VTK's defaults appears in a web page as a tangle of
#            triangles between its own, correct points.
# Needs      npm, node, python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
  libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
npm install --silent --no-audit --no-fund three@0.187.0 >npm.log 2>&1 || {
  cat npm.log >&2
  exit 1
}

# A band of 16 triangles, written by VTK.
cat >write.py <<'PY'
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

points, triangles, surface = vtkPoints(), vtkCellArray(), vtkPolyData()
for k in range(18):
    points.InsertNextPoint(k // 2, k % 2, 0)
for k in range(16):
    triangles.InsertNextCell(3)
    for corner in (k, k + 1, k + 2):
        triangles.InsertCellPoint(corner)
surface.SetPoints(points)
surface.SetPolys(triangles)
print("VTK", vtkVersion().GetVTKVersion())
writer = vtkPolyDataWriter()
writer.SetInputData(surface)
for version in (None, 42):
    if version:
        writer.SetFileVersion(version)
    for form in ("ASCII", "Binary"):
        getattr(writer, f"SetFileTypeTo{form}")()
        writer.SetFileName(f"{form}{version or ''}.vtk")
        writer.Write()
PY

cat >read.mjs <<'JS'
import fs from 'node:fs';
import { REVISION } from 'three';
import { VTKLoader } from 'three/examples/jsm/loaders/VTKLoader.js';

console.warn = () => {};
console.log('three.js', REVISION);
for (const file of ['ASCII.vtk', 'Binary.vtk', 'ASCII42.vtk', 'Binary42.vtk']) {
  const bytes = new Uint8Array(fs.readFileSync(file));
  const version = /Version (\S+)/.exec(new TextDecoder().decode(bytes.subarray(0, 40)))[1];
  let outcome;
  try {
    const geometry = new VTKLoader().parse(bytes.buffer);
    const corners = [...geometry.index.array];
    outcome = `${geometry.attributes.position.count} points, ${corners.length / 3} triangles,`
        + ` largest point number ${Math.max(...corners)}`;
  } catch (error) {
    outcome = `error: ${error.message}`;
  }
  console.log(`${file}, version ${version}: ${outcome}`);
}
JS

{
  LD_LIBRARY_PATH=$PWD/unpacked/usr/lib/x86_64-linux-gnu \
    PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages /usr/bin/python3 write.py
  sed -n '/POLYGONS/,/CONNECTIVITY/p' ASCII.vtk | sed 's/^/  /; s/ *$//'
  node read.mjs 2>/dev/null
} | tee seen

cat >expected <<'SEEN'
VTK 9.1.0
  POLYGONS 17 48
  OFFSETS vtktypeint64
  0 3 6 9 12 15 18 21 24
  27 30 33 36 39 42 45 48
  CONNECTIVITY vtktypeint64
three.js 187
ASCII.vtk, version 5.1: 18 points, 60 triangles, largest point number 48
Binary.vtk, version 5.1: error: Invalid typed array length: -9
ASCII42.vtk, version 4.2: 18 points, 16 triangles, largest point number 17
Binary42.vtk, version 4.2: 18 points, 16 triangles, largest point number 17
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
