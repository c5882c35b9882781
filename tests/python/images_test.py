#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Images and clouds of a recording are the numbers of their files."""

import pathlib
import struct
import tempfile
import unittest
import zlib

import numpy as np
import palpate
from project import BEAM

CAMERA = """depth: {width_px: 4, height_px: 3, fx_px: 100, fy_px: 101, cx_px: 1.5, cy_px: 1,
        distortion: [0.1, 0, 0, 0, 0], unit_m: 0.001, invalid_value: 0, baseline_m: 0}
color: {width_px: 2, height_px: 2, fx_px: 50, fy_px: 50, cx_px: 0.5, cy_px: 0.5, distortion: [],
        registered_to_depth: false,
        T_depth_color: {translation_m: [0.01, 0, 0], rotation_xyzw: [0, 0, 0, 1]}}
"""


def write_png(path, pixels, bits, kind):
    """PNG by its specification: kind 0 is grey, 2 RGB."""
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data +
                struct.pack(">I", zlib.crc32(name + data)))

    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(f">u{bits // 8}").tobytes() for row in pixels)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Images(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.folder.name)
        (root / "experiment.yaml").write_text(f"robot: {BEAM}\nframe: camera\n")
        cls.steps = np.array([[0, 500, 501, 502], [600, 0, 602, 603], [65535, 1, 2, 3]], np.uint16)
        cls.pixels = np.arange(12, dtype=np.uint8).reshape(2, 2, 3) * 20
        for name in ("seen", "points"):
            recording = root / "recordings" / name
            recording.mkdir(parents=True)
            (recording / "recording.yaml").write_text("kind: free\n")
            (recording / "camera.yaml").write_text(CAMERA)
        for kind, pixels, bits, color in (("depth", cls.steps, 16, 0), ("color", cls.pixels, 8, 2)):
            (root / "recordings/seen" / kind).mkdir()
            write_png(root / "recordings/seen" / kind / "1000000000.png", pixels, bits, color)
        (root / "recordings/points/clouds").mkdir()
        (root / "recordings/points/clouds/1000000000.ply").write_text(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n0.25 0.5 0.75\n-0.5 0.125 1\n")
        experiment = palpate.Experiment(cls.folder.name)
        cls.recording = experiment.recording("seen")
        cls.points = experiment.recording("points")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_depth_has_the_steps_of_the_file(self):
        steps = self.recording.depth_steps(0)
        self.assertEqual(steps.dtype, np.uint16)
        np.testing.assert_array_equal(steps, self.steps)

    def test_depth_is_in_metres_and_unknown_where_there_is_none(self):
        depth_m = self.recording.depth_m(-1)
        expected_m = np.where(self.steps == 0, np.nan, self.steps * 0.001).astype(np.float32)
        np.testing.assert_array_equal(depth_m, expected_m)

    def test_colour_and_clouds_are_those_of_the_files(self):
        np.testing.assert_array_equal(self.recording.color(0), self.pixels)
        np.testing.assert_array_equal(self.points.cloud_m(0), [[0.25, 0.5, 0.75], [-0.5, 0.125, 1]])

    def test_the_camera_is_that_of_its_file(self):
        camera = self.recording.camera
        np.testing.assert_array_equal(camera.depth.K, [[100, 0, 1.5], [0, 101, 1], [0, 0, 1]])
        self.assertEqual(list(camera.depth.distortion), [0.1, 0, 0, 0, 0])
        self.assertEqual((camera.depth_unit_m, camera.invalid_value), (0.001, 0))
        self.assertEqual((camera.color.width_px, camera.color_registered), (2, False))
        self.assertEqual(camera.T_depth_color[0, 3], 0.01)

    def test_a_frame_that_is_not_there_is_refused(self):
        with self.assertRaisesRegex(IndexError, "'seen' has 1 depth images, and none of number 1"):
            self.recording.depth_m(1)
        with self.assertRaisesRegex(IndexError, "'points' has 0 colour images"):
            self.points.color(0)


if __name__ == "__main__":
    unittest.main()
