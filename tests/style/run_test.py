#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""./run and .ci/run in a folder of their own, where cmake, ctest and dpkg-query only note how they
are called: which verb builds what, needs which packages, and runs which tests."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTE = '#!/bin/sh\necho "${0##*/} $*" >>"$NOTES"\n'
CTEST = NOTE + """
echo ' 1/2 Test #1: core.Slow.One .......   Passed   12.50 sec'
echo ' 2/2 Test #2: core.Quick.One ......   Passed    0.02 sec'
for k in $(seq "${MORE:-0}"); do echo " 3/3 Test #$k: core.More.Case$k ...... Passed 0.01 sec"; done
echo "${CLOSING:-100% tests passed, 0 tests failed out of 2}"
exit "${STATUS:-0}"
"""
NIGHT = """#!/bin/sh
echo "Night: 3 passed, $NIGHT_FAILED failed, 1 cut off, 0 not begun"
[ "$NIGHT_FAILED" = 0 ]
"""


class RunTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "tools").mkdir()
        (self.root / ".ci").mkdir()
        (self.root / "build/release/bin").mkdir(parents=True)
        shutil.copy(ROOT / "run", self.root / "run")
        shutil.copy(ROOT / ".ci/run", self.root / ".ci/run")
        self.program("tools/cmake", NOTE)
        self.program("tools/ctest", CTEST)
        self.program("tools/cpack", NOTE)
        self.program("tools/dpkg-query", NOTE + "echo installed\n")
        for name in ("palpate", "palpate-bench"):
            self.program(f"build/release/bin/{name}", NOTE)
        self.program(".ci/nightly.py", NIGHT)

    def program(self, path, text):
        file = self.root / path
        file.write_text(text, encoding="utf-8")
        file.chmod(0o755)

    def call(self, *words, **environment):
        notes = self.root / "notes"
        notes.write_text("", encoding="utf-8")
        path = f"{self.root / 'tools'}:{os.environ['PATH']}"
        variables = {**os.environ, "CI": "", "NOTES": str(notes), "NIGHT_FAILED": "0", "PATH": path}
        done = subprocess.run(words, cwd=self.root, env=variables | environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.notes = notes.read_text(encoding="utf-8").splitlines()
        self.output = done.stdout
        return done.returncode

    def noted(self, program):
        return [note for note in self.notes if note.startswith(program + " ")]

    def built(self):
        return [note.rpartition("--target ")[2] for note in self.noted("cmake")
                if "--build" in note]

    def needs(self, package):
        return any(note.endswith(" " + package) for note in self.noted("dpkg-query"))

    def test_build_makes_the_programs_and_needs_no_test_package(self):
        self.assertEqual(self.call("./run", "build"), 0, self.output)
        self.assertEqual(self.built(), ["programs"])
        self.assertTrue(self.needs("libeigen3-dev"))
        for package in ("libgtest-dev", "libembree-dev", "libbenchmark-dev", "chromium"):
            self.assertFalse(self.needs(package), package)
        self.assertEqual(self.noted("ctest"), [])

    def test_demo_makes_the_programs_and_passes_on_its_arguments(self):
        self.assertEqual(self.call("./run", "demo", "--no-window"), 0, self.output)
        self.assertEqual(self.built(), ["programs"])
        self.assertEqual(self.noted("palpate"), ["palpate demo --no-window"])

    def test_test_is_of_the_day(self):
        self.assertEqual(self.call("./run", "test", "-R", "core"), 0, self.output)
        self.assertEqual(self.built(), ["tests"])
        self.assertIn(" -LE nightly -R core", self.noted("ctest")[0])
        self.assertTrue(self.needs("libgtest-dev"))
        self.assertTrue(self.needs("pybind11-dev"))
        self.assertFalse(self.needs("libbenchmark-dev"))

    def test_nightly_is_all(self):
        self.assertEqual(self.call("./run", "test", "--nightly", "-R", "core"), 0, self.output)
        self.assertEqual(self.built(), ["nightly"])
        self.assertTrue(self.noted("ctest")[0].endswith(" -R core"))
        self.assertNotIn("-LE", self.noted("ctest")[0])
        self.assertTrue(self.needs("libbenchmark-dev"))

    def test_bench_makes_the_benchmarks(self):
        self.assertEqual(self.call("./run", "bench", "--benchmark_filter=fem"), 0, self.output)
        self.assertEqual(self.built(), ["palpate-bench"])
        self.assertTrue(self.noted("palpate-bench")[0].endswith(" --benchmark_filter=fem"))

    def test_package_makes_packages_of_programs_and_manuals(self):
        self.assertEqual(self.call("./run", "package"), 0, self.output)
        self.assertEqual(self.built(), ["programs", "manuals"])
        self.assertEqual(self.noted("cpack"), ["cpack --config build/release/CPackConfig.cmake "
                                               "-B build/release/packages"])
        self.assertTrue(self.needs("dpkg-dev"))
        self.assertFalse(self.needs("libgtest-dev"))
        self.assertEqual(self.call("./run", "package", "palpate"), 1)

    def test_wheel_builds_the_python_package_alone(self):
        self.assertEqual(self.call("./run", "wheel"), 0, self.output)
        self.assertEqual(self.built(), ["wheel"])
        self.assertTrue(self.needs("pybind11-dev"))
        self.assertFalse(self.needs("libgtest-dev"))
        self.assertEqual(self.call("./run", "wheel", "here"), 1)

    def test_warnings_are_errors_in_ci_alone(self):
        self.call("./run", "build")
        self.assertIn("cmake --preset release --log-level=NOTICE", self.notes)
        self.call("./run", "build", CI="true")
        self.assertIn("cmake --preset ci --log-level=NOTICE", self.notes)

    def test_refuses_what_it_does_not_know(self):
        self.assertEqual(self.call("./run", "biuld"), 2)
        self.assertIn("usage: ./run VERB", self.output)
        self.assertEqual(self.call("./run", "build", "all"), 1)
        self.assertEqual(self.notes, [])

    def test_ci_counts_the_day_and_the_night_and_names_the_slowest(self):
        self.assertEqual(self.call(".ci/run"), 0, self.output)
        self.assertEqual(self.output.splitlines()[-1], "5 passed, 0 failed")
        self.assertIn("12.50 s  core.Slow.One\n0.02 s  core.Quick.One\n", self.output)

    def test_ci_lists_twenty_of_thousands(self):
        self.assertEqual(self.call(".ci/run", MORE="9000"), 0, self.output[-2000:])
        self.assertEqual(self.output.splitlines()[-1], "5 passed, 0 failed")
        self.assertEqual(self.output.count(" s  core."), 20)

    def test_ci_fails_where_the_night_does(self):
        self.assertNotEqual(self.call(".ci/run", NIGHT_FAILED="2"), 0)
        self.assertEqual(self.output.splitlines()[-1], "5 passed, 2 failed")

    def test_ci_fails_where_the_day_does(self):
        closing = "50% tests passed, 1 tests failed out of 2"
        self.assertNotEqual(self.call(".ci/run", CLOSING=closing, STATUS="8"), 0)
        self.assertEqual(self.output.splitlines()[-1], "1 passed, 1 failed")

    def test_ci_fails_where_no_test_ran(self):
        self.assertNotEqual(self.call(".ci/run", CLOSING=" ", STATUS="1"), 0)
        self.assertEqual(self.output.splitlines()[-1], "0 passed, 1 failed")


if __name__ == "__main__":
    unittest.main()
