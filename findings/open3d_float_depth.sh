#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Open3D 0.16.1 (Debian 12, python3-open3d), depth images of floating-point numbers
# Behaviour  Of a float32 image of 1.0, PointCloud.create_from_depth_image() makes points at a
#            distance of 1. The function of the same name of the tensor API makes 0.001, and so does
#            RGBDImage.create_from_color_and_depth(). All three have depth_scale 1000 by default and
#            agree for uint16. For a depth_scale of 1 they agree for float32.
# Expected   z = d / depth_scale, as the first function documents it for both kinds of images.
# Matters    Rendered depth in metres gives a right cloud with one function, and one a thousand
#            times smaller after a move to the tensor API or to an image with colours.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-open3d=0.16.1+ds-2+b4 libopen3d0.16=0.16.1+ds-2+b4 \
  python3-numpy=1:1.24.2-1+deb12u1 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas OMP_NUM_THREADS=1
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

cat >depth.py <<'PY'
import numpy
import open3d

intrinsic = open3d.camera.PinholeCameraIntrinsic(4, 3, 2.0, 2.0, 1.5, 1.0)
matrix = open3d.core.Tensor(intrinsic.intrinsic_matrix)
color = open3d.geometry.Image(numpy.zeros((3, 4, 3), numpy.uint8))


def show(title, points):
    print(f"  {title}: {float(numpy.asarray(points)[0][2]):.6g}")


print("Open3D", open3d.__version__)
for value, kind, scale in ((1000, numpy.uint16, {}), (1, numpy.float32, {}),
                           (1, numpy.float32, {"depth_scale": 1.0})):
    image = numpy.full((3, 4), value, kind)
    print(f"image of {value} ({kind.__name__}), {scale or 'default depth_scale'}")
    depth = open3d.geometry.Image(image)
    cloud = open3d.geometry.PointCloud.create_from_depth_image(depth, intrinsic, **scale)
    show("PointCloud", cloud.points)
    cloud = open3d.t.geometry.PointCloud.create_from_depth_image(
        open3d.t.geometry.Image(image), matrix, **scale)
    show("t.PointCloud", cloud.point["positions"].numpy())
    both = open3d.geometry.RGBDImage.create_from_color_and_depth(color, depth, **scale)
    cloud = open3d.geometry.PointCloud.create_from_rgbd_image(both, intrinsic)
    show("RGBDImage", cloud.points)
PY

/usr/bin/python3 depth.py | tee seen

cat >expected <<'SEEN'
Open3D 0.16.1
image of 1000 (uint16), default depth_scale
  PointCloud: 1
  t.PointCloud: 1
  RGBDImage: 1
image of 1 (float32), default depth_scale
  PointCloud: 1
  t.PointCloud: 0.001
  RGBDImage: 0.001
image of 1 (float32), {'depth_scale': 1.0}
  PointCloud: 1
  t.PointCloud: 1
  RGBDImage: 1
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
