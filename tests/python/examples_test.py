#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Every script of python/examples runs, and prints what its last lines say it prints."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

from project import BEAM, BEAM_DATA, SOURCE, run_palpate

EXAMPLES = sorted((SOURCE / "python/examples").glob("*.py"))
# The result of each: pattern of a printed line, and the range of its number.
RESULTS = {
    "solve_and_plot.py": (r"tip moved by ([\d.]+) mm", 2.0, 20.0),
    "estimate_recording.py": (r"mean force ([\d.]+) N", 0.459, 0.561),
    "own_loop.py": (r"recovered ([\d.]+) of the force", 0.97, 1.03),
    "own_hypothesis.py": (r"a rubber band at the tip: ([\d.]+) \+-", 3.8, 4.2),
}


class Examples(unittest.TestCase):
    def test_each_has_a_result_here(self):
        self.assertEqual({path.name for path in EXAMPLES}, set(RESULTS))

    def test_each_runs_and_finds_its_result(self):
        for path in EXAMPLES:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                arguments = []
                if path.name == "estimate_recording.py":
                    arguments = [os.path.join(folder, "calibration.yaml")]
                    run_palpate("calibrate", BEAM, "--data", BEAM_DATA, "--recording",
                                "self_weight", "--out", *arguments)
                done = subprocess.run([sys.executable, "-B", path, *arguments], cwd=folder,
                                      text=True, capture_output=True,
                                      env={**os.environ, "MPLBACKEND": "Agg"})
                if "No module named 'matplotlib'" in done.stderr:
                    print("left out: python3-matplotlib is not installed")
                    continue
                self.assertEqual(done.returncode, 0, done.stderr)
                pattern, least, most = RESULTS[path.name]
                number = re.search(pattern, done.stdout)
                self.assertTrue(number, done.stdout)
                self.assertGreater(float(number[1]), least)
                self.assertLess(float(number[1]), most)

    def test_the_notebook_runs_and_finds_the_weight(self):
        try:
            import nbclient
            import nbformat
        except ImportError:
            self.skipTest("python3-nbclient is not installed")
        path = SOURCE / "python/examples/robot_to_forces.ipynb"
        notebook = nbformat.read(path, as_version=4)
        nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3",
                                resources={"metadata": {"path": str(path.parent)}}).execute()
        printed = "".join(output.get("text", "") for cell in notebook.cells
                          for output in cell.get("outputs", []))
        force_N = float(re.search(r"mean force ([\d.]+) N", printed)[1])
        self.assertAlmostEqual(force_N, 0.510, delta=0.051)
        figures = [output for cell in notebook.cells for output in cell.get("outputs", [])
                   if "image/png" in output.get("data", {})]
        self.assertEqual(len(figures), 2)


if __name__ == "__main__":
    unittest.main()
