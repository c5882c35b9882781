#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""palpate-bench runs, writes JSON that holds what was asked for, and refuses what it does not know.

usage: smoke_test.py PROGRAM
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
BEAM_MESH = "read_mesh/beam.msh"
STATISTICS = {"median", "mean", "min"}
CONTEXT = {"processor", "cores", "blas", "element_kernels", "compiler"}


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


class PalpateBench(unittest.TestCase):

    def test_writes_table_and_json(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "bench.json"
            result = run("--benchmark_filter=^read_mesh/beam", "--benchmark_min_time=0.001",
                         "--benchmark_repetitions=3", f"--benchmark_out={file}",
                         "--benchmark_out_format=json")
            self.assertEqual(result.returncode, 0, result.stderr)
            content = json.loads(file.read_text(encoding="utf-8"))
        self.assertIn(BEAM_MESH, result.stdout)
        self.assertLessEqual(CONTEXT, content["context"].keys())
        times = {entry["aggregate_name"]: entry["real_time"] for entry in content["benchmarks"]
                 if entry["name"].startswith(BEAM_MESH)}
        self.assertLessEqual(STATISTICS, times.keys())
        self.assertTrue(0.0 < times["min"] <= times["median"], times)

    def test_has_every_benchmark_of_our_robots(self):
        names = run("--benchmark_list_tests=true").stdout
        for robot in ("four_leg_tet4", "four_leg_tet10", "beam_tet10"):
            for part in ("update_51_points", "update_5_points", "converged_frame_51_points",
                         "assemble_stable_neo_hookean", "factorize", "solve_8_columns"):
                self.assertIn(f"{robot}/{part}/", names)

    def test_refuses_an_unknown_option(self):
        self.assertEqual(run("--no_such_option").returncode, 2)


if __name__ == "__main__":
    unittest.main()
