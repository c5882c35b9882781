#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The wheel: its record is right, and what is unpacked from it works outside of the build."""

import base64
import csv
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import palpate
from project import FOUR_LEG, SOURCE

USE = """
import sys
sys.path.insert(0, sys.argv[1])
import palpate
assert palpate.__file__.startswith(sys.argv[1]), palpate.__file__
print(palpate.Robot(sys.argv[2]).solve().iterations)
"""


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        package = pathlib.Path(palpate.__file__).parent
        said = subprocess.run(
            [sys.executable, "-B", SOURCE / "python/build_wheel.py", package, cls.folder.name],
            capture_output=True, text=True, check=True)
        cls.wheel = pathlib.Path(said.stdout.strip())

    def test_its_name_holds_version_python_and_platform(self):
        self.assertRegex(self.wheel.name,
                         rf"^palpate-{palpate.__version__}-cp3\d+-cp3\d+-linux_\w+\.whl$")

    def test_its_record_has_every_file_with_its_digest(self):
        with zipfile.ZipFile(self.wheel) as archive:
            content = {name: archive.read(name) for name in archive.namelist()}
        record = next(name for name in content if name.endswith("/RECORD"))
        rows = list(csv.reader(content[record].decode().splitlines()))
        self.assertEqual({row[0] for row in rows}, set(content))
        for name, digest, size in rows:
            if name == record:
                continue
            raw = hashlib.sha256(content[name]).digest()
            self.assertEqual(digest, "sha256=" + base64.urlsafe_b64encode(raw).decode().rstrip("="))
            self.assertEqual(int(size), len(content[name]))
        self.assertIn("palpate/py.typed", content)
        self.assertIn("palpate/_engine.pyi", content)

    def test_unpacked_elsewhere_it_solves(self):
        with tempfile.TemporaryDirectory() as folder:
            with zipfile.ZipFile(self.wheel) as archive:
                archive.extractall(folder)
            environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
            said = subprocess.run([sys.executable, "-B", "-c", USE, folder, FOUR_LEG], text=True,
                                  capture_output=True, check=True, env=environment)
        self.assertEqual(int(said.stdout), palpate.Robot(FOUR_LEG).solve().iterations)


if __name__ == "__main__":
    unittest.main()
