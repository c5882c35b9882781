#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The share of the night's tests that CI runs (.ci/nightly.py)."""

import datetime
import importlib.util
import pathlib
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
spec = importlib.util.spec_from_file_location("nightly", ROOT / ".ci/nightly.py")
nightly = importlib.util.module_from_spec(spec)
sys.modules["nightly"] = nightly
spec.loader.exec_module(nightly)


def test_of(name, script, **properties):
    return nightly.Test(name, ("sh", "-c", script), **properties)


class Rotate(unittest.TestCase):
    def test_each_test_is_once_the_first_in_as_many_days(self):
        for count in (1, 2, 3, 10, 57):
            tests = list(range(count))
            firsts = set()
            for day in range(count):
                date = datetime.date(2026, 1, 1) + datetime.timedelta(days=day)
                order = nightly.rotate(tests, date)
                self.assertEqual(sorted(order), tests)
                self.assertEqual(order, nightly.rotate(tests, date))
                firsts.add(order[0])
            self.assertEqual(firsts, set(tests))

    def test_of_no_tests(self):
        self.assertEqual(nightly.rotate([], datetime.date(2026, 1, 1)), [])


class Run(unittest.TestCase):
    def run_tests(self, tests, seconds=30.0, jobs=2):
        self.lines = []
        runner = nightly.Runner(time.monotonic() + seconds, jobs, self.lines.append)
        return dict(runner.run(tests))

    def test_counts_what_passes_and_shows_what_fails(self):
        counts = self.run_tests([test_of("a", "true"), test_of("b", "echo why; exit 3")])
        self.assertEqual(counts, {"passed": 1, "failed": 1, "cut off": 0, "not begun": 0})
        self.assertIn("why\n", self.lines)

    def test_what_lacks_a_tool_is_skipped_with_its_reason(self):
        counts = self.run_tests([test_of("skips", "echo no podman; exit 77", skip_code=77),
                                 test_of("fails", "exit 77")])
        self.assertEqual((counts["skipped"], counts["failed"]), (1, 1))
        self.assertIn("no podman", "".join(self.lines))

    def test_the_end_of_the_time_is_no_failure(self):
        begin = time.monotonic()
        counts = self.run_tests([test_of("a", "sleep 60 & wait"), test_of("b", "true")],
                                seconds=0.5, jobs=1)
        self.assertEqual(counts, {"cut off": 1, "not begun": 1})
        self.assertLess(time.monotonic() - begin, 30.0)

    def test_its_own_limit_is_one(self):
        counts = self.run_tests([test_of("a", "sleep 60", limit_s=0.2)])
        self.assertEqual(counts["failed"], 1)

    def test_runs_alone_what_must_be_alone(self):
        for properties in ({"alone": True}, {"locks": frozenset({"domain"})}):
            tests = [test_of(name, "date +%s%N; sleep 0.3; exit 1", **properties) for name in "ab"]
            begin = time.monotonic()
            self.run_tests(tests)
            self.assertGreater(time.monotonic() - begin, 0.6)

    def test_passes_on_the_environment(self):
        test = test_of("a", '[ "$ROS_DOMAIN_ID" = 23 ]', environment=("ROS_DOMAIN_ID=23",))
        self.assertEqual(self.run_tests([test])["passed"], 1)

    def test_reads_what_ctest_lists(self):
        test = nightly.Test.from_ctest(
            {"name": "a.b", "command": ["program", "--filter=b"],
             "properties": [{"name": "ENVIRONMENT", "value": ["A=1"]},
                            {"name": "TIMEOUT", "value": 300.0},
                            {"name": "RUN_SERIAL", "value": True},
                            {"name": "SKIP_RETURN_CODE", "value": 77},
                            {"name": "RESOURCE_LOCK", "value": ["domain_20"]},
                            {"name": "WORKING_DIRECTORY", "value": "/tmp"}]})
        self.assertEqual(test, nightly.Test("a.b", ("program", "--filter=b"), "/tmp", ("A=1",),
                                            300.0, True, frozenset({"domain_20"}), 77))


if __name__ == "__main__":
    unittest.main()
