#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration from markers: the same as `palpate calibrate`, and Ctrl-C."""

import pathlib
import shutil
import tempfile
import unittest

import numpy as np
import palpate
from project import BEAM, BEAM_DATA, run_palpate


class OfTheBeam(unittest.TestCase):
    """The truth of the data is 0.51 N at the tip of a beam; without a known load the modulus
    follows from its own weight."""

    def test_the_modulus_follows_from_the_weight_and_is_taken_over_by_its_file(self):
        robot = palpate.Robot(BEAM)
        recording = palpate.Experiment(BEAM_DATA).recording("self_weight")
        found = palpate.calibrate(robot, [recording])
        modulus = next(value for value in found.values if "youngs_modulus" in value.name)
        self.assertTrue(modulus.determined)
        self.assertGreater(modulus.standard_error, 0.0)
        self.assertLess(found.residual_rms_m, 1e-3)
        self.assertEqual(robot.youngs_modulus_Pa(), modulus.prior_mean)  # it is as before
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder, "calibration.yaml"))
            found.write(file)
            calibrated = palpate.Robot(BEAM, file)
        self.assertAlmostEqual(calibrated.youngs_modulus_Pa() / modulus.value, 1.0, places=9)

    def test_the_file_is_that_of_the_program(self):
        robot = palpate.Robot(BEAM)
        recording = palpate.Experiment(BEAM_DATA).recording("self_weight")
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder, name) for name in ("program.yaml", "python.yaml")]
            run_palpate("calibrate", BEAM, "--data", BEAM_DATA, "--recording", "self_weight",
                        "--out", files[0])
            palpate.calibrate(robot, [recording]).write(str(files[1]))
            by_program, by_python = (
                [line for line in file.read_text().splitlines() if not line.startswith("date_utc")]
                for file in files)
        self.assertEqual(by_program, by_python)

    def test_exchanged_labels_are_refused_as_by_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder, "experiment")
            shutil.copytree(BEAM_DATA, copy)
            settings = copy / "experiment.yaml"
            text = settings.read_text()
            settings.write_text(text.replace("../../../config/robots/beam.yaml", BEAM))
            for markers in copy.glob("recordings/*/markers.csv"):
                text = markers.read_text()
                for old, new in (("Tip-1", "?"), ("Tip-3", "Tip-1"), ("?", "Tip-3")):
                    text = text.replace(f",{old},", f",{new},")
                markers.write_text(text)
            said = run_palpate("calibrate", BEAM, "--data", str(copy), "--out",
                               pathlib.Path(folder, "c.yaml"), allowed=(1, 2))
            robot = palpate.Robot(BEAM)
            recording = palpate.Experiment(str(copy)).recording("self_weight")
            with self.assertRaisesRegex(palpate.InputError, "exchanged") as raised:
                palpate.calibrate(robot, [recording])
        self.assertIn(str(raised.exception), said)

    def test_without_recordings_or_of_unknown_parts_it_is_refused(self):
        robot = palpate.Robot(BEAM)
        recording = palpate.Experiment(BEAM_DATA).recording("self_weight")
        other = palpate.Experiment(BEAM_DATA).recording("hung_weight")
        with self.assertRaisesRegex(palpate.InputError, "no recording"):
            palpate.calibrate(robot, [])
        with self.assertRaisesRegex(palpate.InputError, "several experiments"):
            palpate.calibrate(robot, [recording, other])
        with self.assertRaisesRegex(palpate.InputError, "no part"):
            palpate.calibrate(robot, [recording], parts=["tip"])


if __name__ == "__main__":
    unittest.main()
