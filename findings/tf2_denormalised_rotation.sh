#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    tf2 0.7.6 (Debian 12, python3-tf2), quaternions that are rounded to two digits
# Behaviour  The quaternion (0, 0, 0.71, 0.71) is accepted without a word and used as it is. A point
#            1 m away in the child frame is found at 1.0082 m, and at 1.025 m through three such
#            frames. Interpolation between two stamps keeps the error. (0, 0, 0.7, 0.7) is refused,
#            with a message.
# Expected   A rigid transform keeps lengths: what the buffer accepts it normalises.
# Matters    A quarter turn is often typed with 0.71. At 1 m from the camera all points are 8 mm too
#            far away, which looks like a wrong focal length or a wrong scale of depth.
# Needs      python3 of Debian 12, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The library, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install python3-tf2=0.7.6-1+b2 libtf2-2d=0.7.6-1+b2 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
export LD_LIBRARY_PATH=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export PYTHONPATH=$PWD/unpacked/usr/lib/python3/dist-packages

cat >turn.py <<'PY'
import rospy
import tf2_py
from geometry_msgs.msg import TransformStamped


def transform(parent, child, time_s, z, w, x=0.0):
    message = TransformStamped()
    message.header.frame_id = parent
    message.header.stamp = rospy.Time(time_s)
    message.child_frame_id = child
    message.transform.translation.x = x
    message.transform.rotation.z = z
    message.transform.rotation.w = w
    return message


def distance(buffer, target, source, time_s=1):
    try:
        found = buffer.lookup_transform_core(target, source, rospy.Time(time_s)).transform
    except tf2_py.LookupException:
        return "unknown frame"
    place = found.translation
    return f"{(place.x**2 + place.y**2 + place.z**2) ** 0.5:.4f} m"


for z, w in ((0.5**0.5, 0.5**0.5), (0.71, 0.71), (0.7, 0.7)):
    buffer = tf2_py.BufferCore(rospy.Duration(10))
    for parent, child in (("base", "a"), ("a", "b"), ("b", "c")):
        for time_s in (1, 3):
            buffer.set_transform(transform(parent, child, time_s, z, w), "test")
    for frame in ("a", "b", "c"):
        for time_s in (1, 3):
            buffer.set_transform(transform(frame, f"point of {frame}", time_s, 0, 1, 1.0), "test")
    print(f"rotation z = {z:.4f}, w = {w:.4f}, point at 1 m")
    print("  one turn:", distance(buffer, "base", "point of a"))
    print("  three turns:", distance(buffer, "base", "point of c"))
    print("  one turn, between two stamps:", distance(buffer, "base", "point of a", 2))
PY

{
  dpkg-deb -f debs/python3-tf2_*.deb Version
  /usr/bin/python3 turn.py 2>messages
  echo "messages: $(grep -c 'invalid quaternion' messages), $(grep -o '(0.*)$' messages | sort -u)"
} | tee seen

cat >expected <<'SEEN'
0.7.6-1+b2
rotation z = 0.7071, w = 0.7071, point at 1 m
  one turn: 1.0000 m
  three turns: 1.0000 m
  one turn, between two stamps: 1.0000 m
rotation z = 0.7100, w = 0.7100, point at 1 m
  one turn: 1.0082 m
  three turns: 1.0248 m
  one turn, between two stamps: 1.0082 m
rotation z = 0.7000, w = 0.7000, point at 1 m
  one turn: unknown frame
  three turns: unknown frame
  one turn, between two stamps: unknown frame
messages: 6, (0.000000 0.000000 0.700000 0.700000)
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
