#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Forces frame by frame: bit for bit those of `palpate estimate`."""

import pathlib
import tempfile
import unittest

import numpy as np
import palpate
from project import BEAM, BEAM_DATA, read_table, run_palpate

CONTACT = "tip: 0, 0.015, 0.03"


def numbers(row, *columns):
    return [float(row[column]) for column in columns]


class AgainstTheProgram(unittest.TestCase):
    def check(self, recording_name, contacts, **settings):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder, "forces.csv")
            sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
            given = [word for contact in contacts for word in ("--contact", contact)]
            run_palpate("estimate", BEAM, "--data", BEAM_DATA, "--recording", recording_name,
                        "--out", table, *given, *sets, allowed=(0, 1))
            rows = read_table(table)
        robot = palpate.Robot(BEAM)
        recording = palpate.Experiment(BEAM_DATA).recording(recording_name)
        if contacts:
            settings["contacts"] = contacts
        estimator = palpate.MarkerEstimator(robot, recording, **settings)
        compared = 0
        for frame in palpate.marker_frames(recording, robot):
            estimate = estimator.update(frame)
            of_frame = [row for row in rows if float(row["t_s"]) == estimate.t_s]
            for row, contact in zip(of_frame, estimate.contacts):
                self.assertEqual(row["status"], contact.status)
                self.assertEqual(row["contact"], contact.name)
                np.testing.assert_array_equal(numbers(row, "fx_N", "fy_N", "fz_N"),
                                              contact.force_N)
                np.testing.assert_array_equal(numbers(row, "x_m", "y_m", "z_m"),
                                              contact.position_m)
                self.assertEqual(float(row["ci95_N"]), contact.ci95_N)
                self.assertEqual(float(row["cov_xy_N2"]), contact.covariance_N2[0, 1])
                compared += 1
        self.assertGreater(compared, 20)

    def test_a_given_contact_has_the_same_force_to_the_last_bit(self):
        self.check("hung_weight", [CONTACT])

    def test_a_found_contact_has_the_same_force_to_the_last_bit(self):
        self.check("hung_weight", [])


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = palpate.Robot(BEAM)
        cls.recording = palpate.Experiment(BEAM_DATA).recording("hung_weight")

    def test_frames_of_arrays_give_what_frames_of_a_recording_give(self):
        by_file = palpate.MarkerEstimator(self.robot, contacts=[CONTACT])
        by_array = palpate.MarkerEstimator(self.robot, contacts=[CONTACT])
        names = self.recording.marker_names
        order = [names.index(name) for name in self.robot.markers]
        for row, frame in enumerate(palpate.marker_frames(self.recording, self.robot)):
            made = by_array.frame(frame.t_s, self.recording.markers_m[row, order], sigma_m=10e-6,
                                  reference="undeformed" if frame.is_reference else "none")
            one, other = by_file.update(frame), by_array.update(made)
            self.assertEqual(one.status, other.status)
            np.testing.assert_array_equal(one.positions_m, other.positions_m)

    def test_an_estimate_stays_when_the_next_comes(self):
        estimator = palpate.MarkerEstimator(self.robot, contacts=[CONTACT])
        frames = palpate.marker_frames(self.recording, self.robot)
        estimates = [estimator.update(frame) for frame in frames]
        last = estimates[-1]
        self.assertTrue(last.usable, last.message)
        self.assertEqual(estimates[0].status, "no_calibration")
        residual_m = last.marker_residual_m
        self.assertEqual(residual_m.shape, (len(self.robot.markers), 3))
        self.assertGreater(np.abs(last.positions_m - estimates[25].positions_m).max(), 0.0)

    def test_a_marker_that_is_not_seen_has_no_residual(self):
        estimator = palpate.MarkerEstimator(self.robot, contacts=[CONTACT])
        markers_m = [estimator.robot.marker(name).centre_m for name in self.robot.markers]
        estimator.update(estimator.frame(0.0, markers_m, reference="undeformed"))
        markers_m[1] = [np.nan] * 3
        estimate = estimator.update(estimator.frame(0.1, markers_m))
        np.testing.assert_array_equal(estimate.marker_residual_m[1], 0.0)

    def test_settings_are_refused_in_the_words_of_settings_files(self):
        for settings in ({"max_contact": 2}, {"max_contacts": 9}, {"max_contacts": "two"},
                         {"marker_sigma_m": -1.0}, {"contacts": "tip"}, {"contacts": ["tip: 0"]}):
            with self.assertRaises(palpate.InputError) as caught:
                palpate.MarkerEstimator(self.robot, **settings)
            self.assertTrue(str(caught.exception), settings)
        with self.assertRaisesRegex(palpate.InputError, "did you mean 'max_contacts'"):
            palpate.MarkerEstimator(self.robot, max_contact=2)

    def test_frames_of_another_shape_or_word_are_refused(self):
        estimator = palpate.MarkerEstimator(self.robot)
        markers_m = np.zeros((len(self.robot.markers), 3))
        for call in (
            lambda: estimator.frame(0.0, markers_m[:-1]),
            lambda: estimator.frame(float("nan"), markers_m),
            lambda: estimator.frame(0.0, markers_m, sigma_m=-1.0),
            lambda: estimator.frame(0.0, markers_m, reference="rest"),
            lambda: estimator.frame(0.0, markers_m, {"nort": 0.0}),
        ):
            with self.assertRaises(palpate.InputError):
                call()


if __name__ == "__main__":
    unittest.main()
