#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The units of systemd, as a package installs them, and what they expose.

usage: units_test.py BUILD_FOLDER
"""

import os
import pathlib
import re
import sys
import tempfile
import unittest

from debian_root import need_tools, run

BUILD = pathlib.Path(sys.argv[1])
# Of 0 (sandboxed) to 10, as systemd-analyze security counts; its "OK" begins at 5.0.
MOST_EXPOSED = 2.0
# Units of systemd that ours refer to; the package does not bring them.
OF_SYSTEMD = ("sysinit", "basic", "shutdown", "network-online", "time-sync", "multi-user")
COMPONENTS = ("capture", "perception", "force-estimation", "calibration", "motion-capture",
              "recorder", "view")


class Units(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name)
        run("cmake", "--install", BUILD, "--component", "programs", "--prefix", "/usr",
            env=os.environ | {"DESTDIR": folder.name})
        cls.units = cls.root / "usr/lib/systemd/system"

    def test_systemd_finds_nothing_wrong(self):
        for name in OF_SYSTEMD:
            (self.units / f"{name}.target").write_text(f"[Unit]\nDescription={name}\n",
                                                       encoding="utf-8")
        for unit in (*(f"palpate@{component}.service" for component in COMPONENTS),
                     "palpate.target"):
            self.assertEqual(run("systemd-analyze", "verify", "--man=no", f"--root={self.root}",
                                 unit), "")

    def test_components_are_sandboxed(self):
        for component in COMPONENTS:
            said = run("systemd-analyze", "security", "--offline=yes", f"--root={self.root}",
                       "--no-pager", f"palpate@{component}.service", check=False)
            exposed = re.search(r"Overall exposure level for \S+: ([\d.]+)", said)
            self.assertIsNotNone(exposed, said)
            print(f"{component}: exposure {exposed[1]}")
            self.assertLessEqual(float(exposed[1]), MOST_EXPOSED, said)

    def test_only_capture_sees_devices(self):
        drop_ins = [folder.name for folder in self.units.glob("*.d")]
        self.assertEqual(drop_ins, ["palpate@capture.service.d"])
        self.assertIn("PrivateDevices=yes",
                      (self.units / "palpate@.service").read_text(encoding="utf-8"))

    def test_every_component_has_its_arguments_in_etc(self):
        names = {file.stem for file in (self.root / "etc/palpate").glob("*.env")}
        self.assertEqual(names, {"palpate", *COMPONENTS})
        conffiles = (BUILD / "debian/conffiles").read_text(encoding="utf-8").split()
        self.assertEqual(sorted(conffiles), sorted(f"/etc/palpate/{name}.env" for name in names))


if __name__ == "__main__":
    need_tools("systemd-analyze")
    unittest.main(argv=sys.argv[:1])
