#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""palpate-bench runs, writes JSON that holds what was asked for, and refuses what it does not know.

usage: smoke_test.py PROGRAM
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
BEAM_MESH = "read_mesh/beam.msh"
STATISTICS = {"median", "mean", "min"}
MODEL = ("multifrontal", "multifrontal_2_threads", "cholmod_supernodal", "cholmod_simplicial")
ALL = MODEL + ("eigen_ldlt",)
STAGES = {"update_51_points": MODEL, "factorize": ALL, "solve_1_column": ALL,
          "solve_8_columns": ALL, "assemble_stable_neo_hookean": ("1_thread", "2_threads")}
OWN_ROBOTS = ["four_leg_tet4", "four_leg_tet10", "beam_tet10"]
SENSING_SETS = ("one_visible", "two_visible", "one_hidden", "nobody_touches", "weights_searched")
CONTEXT = {"processor", "cores", "blas", "element_kernels", "compiler"}


def run(*arguments, **environment):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False,
                          env=os.environ | environment)


def paper_robots(names):
    """Those on the paper's mesh, or on ours where that is not there; the coarsest first."""
    paper = "diamond" if "\ndiamond_tet4/" in names else "stand_in"
    return [f"{paper}_{mesh}" for mesh in ("tet4", "8x_tet4", "64x_tet4", "tet10")]


def run_to_json(*arguments):
    """The finished process, and what it wrote."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "bench.json"
        result = run(*arguments, "--benchmark_repetitions=3", f"--benchmark_out={file}",
                     "--benchmark_out_format=json")
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        return result, json.loads(file.read_text(encoding="utf-8"))


def minima(content):
    return {entry["run_name"].split("/iterations")[0]: entry for entry in content["benchmarks"]
            if entry.get("aggregate_name") == "min"}


class PalpateBench(unittest.TestCase):

    def test_writes_table_and_json(self):
        result, content = run_to_json("--benchmark_filter=^read_mesh/beam")
        self.assertIn(BEAM_MESH, result.stdout)
        self.assertLessEqual(CONTEXT, content["context"].keys())
        times = {entry["aggregate_name"]: entry["real_time"] for entry in content["benchmarks"]
                 if entry["name"].startswith(BEAM_MESH)}
        self.assertLessEqual(STATISTICS, times.keys())
        self.assertTrue(0.0 < times["min"] <= times["median"], times)

    def test_has_every_benchmark_of_every_robot(self):
        names = run("--benchmark_list_tests=true").stdout
        for robot in OWN_ROBOTS + paper_robots(names):
            for stage, contenders in STAGES.items():
                for contender in contenders:
                    self.assertIn(f"\n{robot}/{stage}/{contender}/", names)
        for robot in OWN_ROBOTS:
            for part in ("update_5_points", "converged_frame_51_points"):
                self.assertIn(f"\n{robot}/{part}/", names)
        self.assertIn("\ndgemm_768/", names)
        for points in (51, 15):
            self.assertIn(f"\nsensing/estimate_{points}_points/", names)
        self.assertIn("\nsensing/frame_costs/", names)
        for eyes in ("whole", "ideal_perception"):
            for part in SENSING_SETS:
                self.assertIn(f"\nsensing/{eyes}/{part}/", names)

    def test_compares_the_solvers(self):
        result, content = run_to_json("--benchmark_filter=^dgemm|four_leg_tet4/(factorize|solve)")
        entries = minima(content)
        for stage in ("factorize", "solve_1_column", "solve_8_columns"):
            ours = entries[f"four_leg_tet4/{stage}/multifrontal"]
            self.assertEqual(ours["ratio"], 1.0)
            for contender in ALL:
                name = f"four_leg_tet4/{stage}/{contender}"
                self.assertIn(name, result.stdout)
                entry = entries[name]
                self.assertEqual(entry["rows"], ours["rows"])
                for figure in ("memory_MiB", "flops", "factor_nonzeros"):
                    self.assertGreater(entry[figure], 0.0, name)
                self.assert_figures_agree(entry, ours, entries["dgemm_768"], name)

    def assert_figures_agree(self, entry, ours, dgemm, name):
        of_threads = 2 if name.endswith("_2_threads") else 1
        compared_ms = entry["real_time" if of_threads == 2 else "cpu_time"]
        self.assertAlmostEqual(entry["ratio"] * ours["cpu_time"] / compared_ms, 1.0, 6, name)
        gflop_per_s = 1e-6 * entry["flops"] / compared_ms
        self.assertAlmostEqual(entry["GFLOP_per_s"] / gflop_per_s, 1.0, 6, name)
        percent = 100.0 * gflop_per_s / (of_threads * dgemm["GFLOP_per_s"])
        self.assertAlmostEqual(entry["percent_of_dgemm_peak"] / percent, 1.0, 6, name)

    def test_all_solvers_factorise_what_one_factor_needs(self):
        _, content = run_to_json("--benchmark_filter=beam_tet10/factorize/")
        nonzeros = {name.rsplit("/", 1)[1]: entry["factor_nonzeros"]
                    for name, entry in minima(content).items()}
        self.assertEqual(nonzeros["multifrontal"], nonzeros["multifrontal_2_threads"])
        self.assertEqual(nonzeros["cholmod_supernodal"], nonzeros["cholmod_simplicial"])
        # Zeros in merged fronts, and another order of elimination.
        for contender in ("multifrontal", "eigen_ldlt"):
            self.assertTrue(0.5 < nonzeros[contender] / nonzeros["cholmod_simplicial"] < 2.0)

    def test_fits_the_scaling_law_of_the_refined_meshes(self):
        names = run("--benchmark_list_tests=true").stdout
        family = paper_robots(names)[:2]
        result, content = run_to_json(
            f"--benchmark_filter=({'|'.join(family)})/factorize/multifrontal/")
        self.assertIn("factor_flops", result.stdout)
        laws = {entry["name"]: entry for entry in content["benchmarks"]
                if entry["name"].startswith("scaling_law/")}
        entries = minima(content)
        coarse, fine = (entries[f"{robot}/factorize/multifrontal"] for robot in family)
        self.assertGreater(fine["rows"], 4 * coarse["rows"])
        law = laws["scaling_law/factor_flops"]
        self.assertEqual(law["meshes"], 2)
        for entry in (coarse, fine):
            fitted = law["factor"] * entry["rows"] ** law["exponent"]
            self.assertAlmostEqual(fitted / entry["flops"], 1.0, 6)
        self.assertTrue(1.0 < law["exponent"] < 3.0, law)
        self.assertIn("scaling_law/factorize_multifrontal_ms", laws)

    def test_refuses_a_filter_that_nothing_matches(self):
        result = run("--benchmark_filter=no_such_benchmark")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no_such_benchmark", result.stderr)

    def test_refuses_an_output_other_than_json(self):
        self.assertEqual(run("--benchmark_out=x", "--benchmark_out_format=csv").returncode, 2)

    def test_refuses_a_file_that_cannot_be_written(self):
        result = run("--benchmark_filter=^read_mesh/beam", "--benchmark_out=/no/such/folder/x.json")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/no/such/folder/x.json", result.stderr)

    def test_refuses_a_size_of_the_sensing_sets_that_is_no_number(self):
        result = run("--benchmark_list_tests=true", PALPATE_SENSING_CONTACTS="many")
        self.assertEqual(result.returncode, 2)
        self.assertIn("PALPATE_SENSING_CONTACTS", result.stderr)

    def test_hides_causes_only_where_it_is_told_how_many(self):
        self.assertNotIn("diagnosis/blind", run("--benchmark_list_tests=true").stdout)
        names = run("--benchmark_list_tests=true", PALPATE_BLIND_CASES="2").stdout
        self.assertIn("\ndiagnosis/blind/", names)
        self.assertIn("\ndiagnosis/next_experiment/", names)
        result = run("--benchmark_list_tests=true", PALPATE_BLIND_CASES="0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("PALPATE_BLIND_CASES", result.stderr)

    def test_refuses_an_unknown_option(self):
        self.assertEqual(run("--no_such_option").returncode, 2)


if __name__ == "__main__":
    unittest.main()
