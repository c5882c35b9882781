#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Each kind of file that laboratories bring is read as it means it: one test for each.

usage: cases_test.py PROGRAM
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import make_cases as cases

PROGRAM = sys.argv.pop(1)
# Files that no verb takes: their first bytes, and what `info` must call them.
OTHERS = {
    "part.stl": (b"solid part\nfacet normal 0 0 1\n", "STL surface", "mesh the body"),
    "part.obj": (b"v 0 0 0\n", "Wavefront OBJ", "mesh the body"),
    "part.off": (b"OFF\n4 4 0\n", "OFF surface", "mesh the body"),
    "part.step": (b"ISO-10303-21;\nHEADER;\n", "STEP geometry", "mesh the body"),
    "part.geo": (b"Point(1) = {0, 0, 0};\n", "geometry for Gmsh", "gmsh -3"),
    "part.unv": (b"    -1\n  2411\n", "I-DEAS universal file", "convert"),
    "part.vol": (b"mesh3d\ndimension\n3\n", "Netgen mesh", "Gmsh 2"),
    "part.meshb": (b"\x01\0\0\0\x03\0\0\0", "binary Medit mesh", ".mesh"),
    "part.xdmf": (b"<?xml version='1.0'?><Xdmf/>", "XDMF mesh", "convert"),
    "part.med": (b"\x89HDF\r\n\x1a\n", "HDF5 file", "no verb"),
    "run.bag": (b"#ROSBAG V2.0\n", "ROS 1 bag", "MCAP"),
    "run.npy": (b"\x93NUMPY\x01\0", "NumPy array", "CSV"),
    "run.mat": (b"MATLAB 5.0 MAT-file", "MATLAB file", "table"),
    "run.xlsx": (b"PK\x03\x04\x14\0", "ZIP archive", "CSV"),
    "run.mp4": (b"\0\0\0\x18ftypmp42", "video", "MCAP"),
    "actuation.csv": (b"t_s,north,south\n0,0,0\n", "table", "actuation.csv and loads.csv belong"),
    "run.json": (b'{"a": 1}\n', "JSON file", "no verb"),
    "paper.pdf": (b"%PDF-1.7\n", "PDF document", "no verb"),
    "image.png": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "PNG image", "depth/ or color/"),
    "image.jpg": (b"\xff\xd8\xff\xe0\0\x10JFIF", "JPEG image", "depth/ or color/"),
}


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          check=False, timeout=60)


class Case(unittest.TestCase):

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def write(self, name, data):
        file = self.folder / name
        file.write_bytes(data)
        return file

    def info(self, file, *options):
        result = run("info", file, "--json", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def check_mesh(self, name, data):
        found = self.info(self.write(name, data), "--unit", "mm")
        _, cells, left = cases.bar()
        self.assertEqual(found["mesh"]["cells"], len(cells))
        self.assertEqual(found["mesh"]["inverted_cells"], 0)
        self.assertAlmostEqual(found["mesh"]["volume_m3"], 1e-9 * cases.VOLUME_MM3, delta=1e-18)
        sizes = {group["cells"] for group in found["groups"]}
        if name not in ("netgen.msh", "lagrange.vtk"):
            self.assertIn(sum(left), sizes, found["groups"])
        if name.startswith("gmsh"):
            self.assertEqual(found["groups"], [{"name": "all", "cells": len(cells)},
                                               {"name": "left", "cells": sum(left)}])

    def check_capture(self, name, data):
        out = self.folder / "experiment"
        result = run("import", self.write(name, data), "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        with (out / "markers.csv").open(newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        seen = {(row["marker"].split(":")[-1], round(float(row["t_s"]) * cases.RATE_HZ)): row
                for row in rows if row["x_m"]}
        # As the formats round: integers of 0.1 mm, and metres with six decimals.
        step_mm = 0.05 if "integers" in name else 5.1e-4 if "motive" in name else 1e-4
        for marker in cases.MARKERS:
            for frame in range(cases.FRAMES):
                row, place = seen.pop((marker, frame), None), cases.position_mm(marker, frame)
                self.assertEqual(row is None, place is None, (marker, frame))
                for axis, value in zip("xyz", place or ()):
                    self.assertAlmostEqual(1e3 * float(row[f"{axis}_m"]), value, delta=step_mm)
        self.assertFalse(seen, "markers or frames that the file does not have")

    def check_cloud(self, name, data):
        found = self.info(self.write(name, data))
        self.assertEqual(found["points"], cases.COLUMNS * cases.ROWS)
        self.assertTrue(found["colored"])
        notes = {"viewer.ply": "y and z are negated", "millimetres.ply": "millimetres"}
        self.assertIn(notes.get(name, ""), found["note"])
        self.assertEqual(found["note"] == "", name not in notes)

    def check_other(self, name, data):
        begin, kind, advice = data
        result = run("info", self.write(name, begin + b"\n" + b"x" * 3000))
        text = result.stdout + result.stderr
        self.assertEqual(result.returncode, 0, text)
        self.assertIn(kind, text)
        self.assertIn(advice, text)
        self.assertLess(len(text), 600)

    def test_a_viewpoint_that_is_not_the_camera_is_refused(self):
        moved = cases.pcd().replace(b"VIEWPOINT 0 0 0 1", b"VIEWPOINT 0 0 0.5 1")
        result = run("info", self.write("moved.pcd", moved))
        self.assertEqual(result.returncode, 2)
        self.assertIn("write VIEWPOINT 0 0 0 1 0 0 0", result.stderr)

    def test_what_is_of_no_kind_is_said_in_one_line(self):
        for begin in (b"what is this?\n" + b"y" * 100000, bytes(range(256)) * 400):
            result = run("info", self.write("thing.xyzzy", begin))
            self.assertEqual(result.returncode, 2)
            self.assertEqual(result.stderr.count("\n"), 1)
            self.assertIn("is of no kind that is known", result.stderr)
            self.assertLess(len(result.stderr), 600)


def add_tests(kind, files):
    for name, data in files.items():
        def test(self, name=name, data=data):
            getattr(self, "check_" + kind)(name, data)
        setattr(Case, f"test_{kind}_" + name.replace(".", "_"), test)


add_tests("mesh", cases.MESHES)
add_tests("capture", cases.CAPTURES)
add_tests("cloud", cases.CLOUDS)
add_tests("other", OTHERS)

if __name__ == "__main__":
    unittest.main()
