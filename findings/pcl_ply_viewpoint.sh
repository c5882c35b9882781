#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    PCL 1.13.0 (Debian 12, pcl-tools 1.13.0+dfsg-3), the sensor's pose in a PLY file
# Behaviour  A PCD file keeps the sensor's pose as VIEWPOINT, and PCL's PLY files have an element
#            "camera" for it. pcl_pcd2ply -use_camera 1 writes a camera at the origin that is not
#            turned, whatever VIEWPOINT is. pcl_ply2pcd reads a camera that is elsewhere, and
#            writes the VIEWPOINT of the origin. Both exit with 0.
# Expected   The pose that the option -use_camera writes is that of the file, and it comes back.
# Matters    The pose of a camera is lost on the way through PLY, and the files look as if it were
#            known. Normals that are turned to the sensor are turned to another place.
# Needs      apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The programs, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install pcl-tools=1.13.0+dfsg-3 libpcl-io1.13=1.13.0+dfsg-3 \
  libpcl-common1.13=1.13.0+dfsg-3 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$PWD/$libraries:$PWD/$libraries/lapack:$PWD/$libraries/blas
export PATH=$PWD/unpacked/usr/bin:$PATH

# A sensor at (1, 2, 3), turned by 90 degrees about z.
cat >cloud.pcd <<'PCD'
VERSION .7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT 1 2 3 0.7071068 0 0 0.7071068
POINTS 2
DATA ascii
0.1 0.2 0.3
0.4 0.5 0.6
PCD

# convert PROGRAM OPTIONS IN OUT: prints its exit code.
convert() {
  local status=0
  "$@" >log 2>&1 || status=$?
  echo "$*: exit $status"
}

# camera FILE: the first six values of the element "camera", its place and its axis x.
camera() { echo "  camera: $(tail -1 "$1" | cut -d ' ' -f 1-6)"; }

{
  dpkg-deb -f debs/libpcl-io1.13_*.deb Package Version
  echo "cloud.pcd"
  grep VIEWPOINT cloud.pcd | sed 's/^/  /'
  convert pcl_pcd2ply -format 0 -use_camera 1 cloud.pcd cloud.ply
  camera cloud.ply

  # The same file with its camera where the sensor is.
  sed '$s/^0 0 0 1 0 0 0 1 0 0 0 1/1 2 3 0 1 0 -1 0 0 0 0 1/' cloud.ply >posed.ply
  echo "posed.ply"
  camera posed.ply
  convert pcl_ply2pcd -format 0 posed.ply posed.pcd
  grep VIEWPOINT posed.pcd | sed 's/^/  /'
} 2>&1 | tee seen

cat >expected <<'SEEN'
Package: libpcl-io1.13
Version: 1.13.0+dfsg-3
cloud.pcd
  VIEWPOINT 1 2 3 0.7071068 0 0 0.7071068
pcl_pcd2ply -format 0 -use_camera 1 cloud.pcd cloud.ply: exit 0
  camera: 0 0 0 1 0 0
posed.ply
  camera: 1 2 3 0 1 0
pcl_ply2pcd -format 0 posed.ply posed.pcd: exit 0
  VIEWPOINT 0 0 0 1 0 0 0
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
