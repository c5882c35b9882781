#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Open3D 0.16.1 with Embree 3.13.5 (Debian 12), RaycastingScene
# Behaviour  No ray hits anything: cast_rays() returns inf for rays through a box. So no point is
#            inside, and compute_signed_distance() is positive everywhere, with the right size.
#            There is no error. Debian's Embree is built with ray masks, and the masks that Open3D
#            sends select no geometry. A wrapper that sets all their bits makes everything right.
# Expected   Hits on both sides of the box, occupancy 1 and a negative distance inside, as Open3D
#            documents it.
# Matters    Where a scan is compared with a model, all points seem to lie outside, and rendered
#            depth images are empty. Distances alone look healthy.
# Needs      gcc, python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-open3d=0.16.1+ds-2+b4 libopen3d0.16=0.16.1+ds-2+b4 \
  libembree3-3=3.13.5+dfsg-2 libembree-dev=3.13.5+dfsg-2 python3-numpy=1:1.24.2-1+deb12u1 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries:$libraries/lapack:$libraries/blas OMP_NUM_THREADS=1
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

# Embree's two functions that Open3D calls for rays, with all bits of the masks set.
cat >all_bits.c <<'C'
#include <dlfcn.h>
#include <embree3/rtcore.h>

typedef void (*Function)(RTCScene, struct RTCIntersectContext*, void*, unsigned, size_t);

static void Call(const char* name, RTCScene scene, struct RTCIntersectContext* context,
                 void* rays, unsigned count, size_t stride) {
  for (unsigned k = 0; k < count; ++k) {
    ((struct RTCRay*)((char*)rays + k * stride))->mask = 0xFFFFFFFFu;
  }
  void* embree = dlopen("libembree3.so.3", RTLD_LAZY);
  ((Function)dlsym(embree, name))(scene, context, rays, count, stride);
}

void rtcIntersect1M(RTCScene scene, struct RTCIntersectContext* context, struct RTCRayHit* rays,
                    unsigned count, size_t stride) {
  Call("rtcIntersect1M", scene, context, rays, count, stride);
}

void rtcOccluded1M(RTCScene scene, struct RTCIntersectContext* context, struct RTCRay* rays,
                   unsigned count, size_t stride) {
  Call("rtcOccluded1M", scene, context, rays, count, stride);
}
C
gcc -O1 -shared -fPIC -isystem unpacked/usr/include all_bits.c -o all_bits.so

cat >rays.py <<'PY'
import ctypes

import numpy
import open3d

MASKS_SUPPORTED = 64
embree = ctypes.CDLL("libembree3.so.3")
embree.rtcNewDevice.restype = ctypes.c_void_p
embree.rtcGetDeviceProperty.restype = ctypes.c_ssize_t
device = ctypes.c_void_p(embree.rtcNewDevice(None))
print("Open3D", open3d.__version__, "ray masks of Embree:",
      embree.rtcGetDeviceProperty(device, MASKS_SUPPORTED))


def tensor(rows):
    return open3d.core.Tensor(numpy.array(rows, numpy.float32))


box = open3d.geometry.TriangleMesh.create_box(1, 2, 3)
scene = open3d.t.geometry.RaycastingScene()
scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(box))
rays = tensor([[0.6, 0.9, -5, 0, 0, 1], [0.6, 0.9, 8, 0, 0, -1]])
points = tensor([[0.6, 0.9, 1.2], [1.6, 0.9, 1.2]])
print("  distance of hits on the box:", scene.cast_rays(rays)["t_hit"].numpy())
print("  number of hits:", scene.count_intersections(rays).numpy())
print("  inside and outside, occupancy:", scene.compute_occupancy(points).numpy())
print("  inside and outside, signed distance:", scene.compute_signed_distance(points).numpy())
PY

{
  /usr/bin/python3 rays.py
  echo "with all bits of the masks:"
  LD_PRELOAD=$PWD/all_bits.so /usr/bin/python3 rays.py
} | tee seen

cat >expected <<'SEEN'
Open3D 0.16.1 ray masks of Embree: 1
  distance of hits on the box: [inf inf]
  number of hits: [0 0]
  inside and outside, occupancy: [0. 0.]
  inside and outside, signed distance: [0.39999998 0.6       ]
with all bits of the masks:
Open3D 0.16.1 ray masks of Embree: 1
  distance of hits on the box: [5. 5.]
  number of hits: [2 2]
  inside and outside, occupancy: [1. 0.]
  inside and outside, signed distance: [-0.39999998  0.6       ]
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
