#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Experiments and recordings as arrays."""

import pathlib
import tempfile
import unittest

import numpy as np
import palpate
from project import BEAM, BEAM_DATA, read_table


class MeasuredBeam(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.experiment = palpate.Experiment(BEAM_DATA)
        cls.recording = cls.experiment.recording("hung_weight")

    def test_has_what_its_folder_says(self):
        self.assertEqual([one.name for one in self.experiment.recordings],
                         ["hung_weight", "self_weight"])
        self.assertTrue(pathlib.Path(self.experiment.robot).samefile(BEAM))
        self.assertEqual(self.recording.kind, "free")
        self.assertEqual(self.recording.frame, "robot")
        self.assertEqual(self.recording.steady_window_s, (1.55, 2.95))
        self.assertEqual(self.recording.displacement_m, {})

    def test_markers_are_the_numbers_of_the_table(self):
        rows = read_table(pathlib.Path(self.recording.folder, "markers.csv"))
        markers_m = self.recording.markers_m
        names = self.recording.marker_names
        self.assertEqual(markers_m.shape, (len(self.recording.marker_t_s), len(names), 3))
        frame = {t_s: index for index, t_s in enumerate(self.recording.marker_t_s)}
        self.assertGreater(len(rows), 100)
        for row in rows:
            there = markers_m[frame[float(row["t_s"])], names.index(row["marker"])]
            if row["x_m"]:
                self.assertEqual(list(there), [float(row[axis]) for axis in
                                               ("x_m", "y_m", "z_m")])
            else:
                self.assertTrue(np.isnan(there).all())

    def test_arrays_are_views_that_outlive_the_experiment(self):
        markers_m = palpate.Experiment(BEAM_DATA).recording("hung_weight").markers_m
        np.testing.assert_array_equal(markers_m, self.recording.markers_m)
        self.assertFalse(markers_m.flags.owndata)
        self.assertFalse(markers_m.flags.writeable)
        self.assertTrue(np.shares_memory(self.recording.markers_m, self.recording.markers_m))

    def test_an_unknown_recording_is_refused_with_what_was_meant(self):
        with self.assertRaisesRegex(palpate.InputError, "did you mean 'hung_weight'"):
            self.experiment.recording("hung_weigth")

    def test_a_file_without_messages_is_refused(self):
        with self.assertRaisesRegex(palpate.InputError, "beam.yaml: is no folder"):
            palpate.Experiment(BEAM)


class Tables(unittest.TestCase):
    def write(self, folder, actuation):
        recording = pathlib.Path(folder, "recordings/one")
        recording.mkdir(parents=True)
        pathlib.Path(folder, "experiment.yaml").write_text("frame: robot\n", encoding="utf-8")
        (recording / "recording.yaml").write_text("kind: ramp\n", encoding="utf-8")
        (recording / "actuation.csv").write_text(actuation, encoding="utf-8")

    def test_actuation_is_by_cable_with_nan_for_empty_fields(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder, "t_s,north.displacement_m,east.tension_N\n0,0.001,\n1,,2.5\n")
            recording = palpate.Experiment(folder).recording("one")
        np.testing.assert_array_equal(recording.actuation_t_s, [0.0, 1.0])
        np.testing.assert_array_equal(recording.displacement_m["north"], [0.001, np.nan])
        np.testing.assert_array_equal(recording.tension_N["east"], [np.nan, 2.5])
        self.assertEqual(recording.marker_names, [])
        self.assertEqual(recording.markers_m.shape, (0, 0, 3))

    def test_a_bad_table_is_refused_with_its_line_and_column(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder, "t_s,north.displacement_mm\n0,1\n")
            with self.assertRaisesRegex(palpate.InputError, r"actuation\.csv:1:\d+: "):
                palpate.Experiment(folder)


if __name__ == "__main__":
    unittest.main()
