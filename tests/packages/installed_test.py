#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""An installed tree runs from another place than it was installed to, without sources and build.

usage: installed_test.py SOURCE_FOLDER BUILD_FOLDER
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from debian_root import run, skip

FOLDERS = [pathlib.Path(word) for word in sys.argv[1:3]]


def hide(folders):
    """The beginning of a command that sees empty folders instead of these; inner ones first."""
    mounts = " && ".join(f"mount -t tmpfs none '{folder}'"
                         for folder in sorted(folders, reverse=True))
    return ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
            f'{mounts} && cd "$PWD" && exec "$@"', "sh"]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        run("cmake", "--install", FOLDERS[1], "--component", "programs", "--prefix", root / "a")
        (root / "a").rename(root / "moved")
        cls.prefix = root / "moved"
        cls.work = root / "work"
        cls.work.mkdir()

    def call(self, program, *words):
        return run(*hide(FOLDERS), self.prefix / "bin" / program, *words, cwd=self.work)

    def test_the_sources_are_hidden(self):
        self.assertEqual(run(*hide(FOLDERS), "ls", FOLDERS[0], cwd="/"), "")

    def test_robots_are_found_by_name(self):
        for robot in ("beam", "four_leg", "rod"):
            self.assertIn(f'"robot": "{robot}"', self.call("palpate", "info", robot, "--json"))

    def test_processes_know_their_settings(self):
        for program in (self.prefix / "bin").glob("palpate-*"):
            self.assertIn("dds", self.call(program.name, "--print-config"))

    def test_the_demonstration_of_the_beam_runs(self):
        self.assertIn("inside the interval",
                      self.call("palpate", "demo", "--recording", "beam", "--computed"))
        self.assertTrue((self.work / "palpate_demo/scene.png").is_file())

    def test_units_name_the_programs_of_the_prefix(self):
        unit = (self.prefix / "lib/systemd/system/palpate@.service").read_text(encoding="utf-8")
        self.assertIn(f"ExecStart={self.prefix.parent}/a/bin/palpate-%i", unit)
        self.assertNotIn("@prefix@", unit)
        self.assertTrue((self.prefix / "etc/palpate/palpate.env").is_file())


if __name__ == "__main__":
    if subprocess.run(hide(FOLDERS) + ["true"], cwd="/", capture_output=True,
                      check=False).returncode != 0:
        skip("no mount namespace of its own here: the sources cannot be hidden")
    unittest.main(argv=sys.argv[:1])
