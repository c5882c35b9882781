#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    PCL 1.13.0 (Debian 12, pcl-tools 1.13.0+dfsg-3), PLY written from a coloured PCD
# Behaviour  PCL stores "rgb" as TYPE F in a binary PCD and as TYPE U in an ASCII PCD. From a cloud
#            that was read from the latter, the PLY writer announces three colours of one byte and
#            writes one packed integer of four bytes. pcl_pcd2ply exits with 0. PCL itself cannot
#            read its ASCII PLY. It reads its binary PLY, with exit code 0, as wrong points: a
#            vertex takes 16 bytes where the header promises 15.
# Expected   Both PCD files hold the same cloud, in a form that PCL chose. The PLY files are equal,
#            and PCL reads back what it wrote.
# Matters    A camera's clouds kept as ASCII PCD and converted to binary PLY keep the number of
#            points, and all points but the first are wrong. So are all colours.
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

cat >cloud.ply <<'PLY'
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
end_header
0.1 0.2 0.3 255 128 0
0.4 0.5 0.6 0 128 255
0.7 0.8 0.9 10 20 30
PLY

# convert FORMAT: the cloud as a PCD (0: ASCII, 1: binary), as PLY files of both kinds, and back.
convert() {
  local status form
  pcl_ply2pcd -format "$1" cloud.ply cloud.pcd >log 2>&1
  echo "PCD $(sed -n 's/^DATA //p' cloud.pcd), rgb is TYPE $(sed -n 's/^TYPE F F F //p' cloud.pcd)"
  for form in 1 0; do
    status=0
    pcl_pcd2ply -format "$form" -use_camera 0 cloud.pcd out.ply >log 2>&1 || status=$?
    echo "  PLY $(sed -n 's/^format \([a-z]*\).*/\1/p' out.ply): exit $status," \
      "header: $(grep -a -c 'property float' out.ply) float" \
      "+ $(grep -a -c 'property uchar' out.ply) uchar," \
      "body: $(sed '1,/^end_header$/d' out.ply | wc -c) bytes"
    rm -f back.pcd
    status=0
    pcl_ply2pcd -format 0 out.ply back.pcd >log 2>&1 || status=$?
    echo "    read back: exit $status"
    if ((status == 0)); then sed '1,/^DATA/d; s/^/    /' back.pcd; fi
  done
}

{
  dpkg-deb -f debs/libpcl-io1.13_*.deb Package Version
  convert 1
  convert 0
} 2>&1 | tee seen

cat >expected <<'SEEN'
Package: libpcl-io1.13
Version: 1.13.0+dfsg-3
PCD binary, rgb is TYPE F
  PLY binary: exit 0, header: 3 float + 3 uchar, body: 45 bytes
    read back: exit 0
    0.1 0.2 0.30000001 16744448
    0.40000001 0.5 0.60000002 33023
    0.69999999 0.80000001 0.89999998 660510
  PLY ascii: exit 0, header: 3 float + 3 uchar, body: 65 bytes
    read back: exit 0
    0.1 0.2 0.30000001 16744448
    0.40000001 0.5 0.60000002 33023
    0.69999999 0.80000001 0.89999998 660510
PCD ascii, rgb is TYPE U
  PLY binary: exit 0, header: 3 float + 3 uchar, body: 48 bytes
    read back: exit 0
    0.1 0.2 0.30000001 33023
    -1.0737459e+08 8.6880505e-44 1.5882129e-23 4194176
    4.1676685e-08 -1.0760847e+08 2.7182798e+23 6700830
  PLY ascii: exit 0, header: 3 float + 3 uchar, body: 58 bytes
    read back: exit 255
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
