#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""What Python adds to the engine, measured in one run; no absolute times of the engine.

After an update of milliseconds the processor's caches hold nothing of Python, and whatever runs
next is slow: numpy.zeros(3), too. So the cost of the call is measured with frames that the engine
only stores, and what the caches add is measured beside it."""

import statistics
import time
import unittest

import palpate
from project import BEAM, BEAM_DATA

FRAMES = 1000
CONTACT = "tip: 0, 0.015, 0.03"


class Overhead(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        robot = palpate.Robot(BEAM)
        recording = palpate.Experiment(BEAM_DATA).recording("hung_weight")
        estimator = palpate.MarkerEstimator(robot, recording, contacts=[CONTACT])
        names = recording.marker_names
        order = [names.index(name) for name in robot.markers]
        for frame in palpate.marker_frames(recording, robot):
            if frame.is_reference:
                estimator.update(frame)
        measured_m = recording.markers_m[recording.marker_t_s > 1.0][:, order].copy()
        at_rest_m = [robot.marker(name).centre_m for name in robot.markers]
        cls.outside_s, cls.inside_s = [], []
        for index in range(FRAMES):
            markers_m = measured_m[index % len(measured_m)]
            start = time.perf_counter()
            estimate = estimator.update(estimator.frame(0.05 * index, markers_m, sigma_m=1e-5))
            force_N = [contact.force_N for contact in estimate.contacts]
            cls.outside_s.append(time.perf_counter() - start)
            cls.inside_s.append(estimate.time_s)
        cls.last = force_N
        cls.stored_s = []
        for index in range(FRAMES):
            start = time.perf_counter()
            stored = estimator.update(
                estimator.frame(60.0, at_rest_m, sigma_m=1e-5, reference="undeformed"))
            read_N = [contact.force_N for contact in estimate.contacts]
            cls.stored_s.append(time.perf_counter() - start - stored.time_s)
        assert len(read_N) == len(force_N) == 1

    def test_the_call_costs_at_most_20_us(self):
        added_us = 1e6 * statistics.median(self.stored_s)
        print(f"call: median {added_us:.1f} us with warm caches")
        self.assertLess(added_us, 20.0)

    def test_what_python_adds_to_an_update_is_small_beside_it(self):
        added_s = [outside - inside for outside, inside in zip(self.outside_s, self.inside_s)]
        inside_s = statistics.median(self.inside_s)
        print(f"added: median {1e6 * statistics.median(added_s):.1f} us, least "
              f"{1e6 * min(added_s):.1f} us; engine: median {1e3 * inside_s:.3f} ms")
        self.assertLess(statistics.median(added_s), 0.05 * inside_s)
        self.assertEqual(len(self.last), 1)

    def test_a_loop_of_1000_frames_has_90_percent_of_the_speed_of_the_engine(self):
        share = sum(self.inside_s) / sum(self.outside_s)
        print(f"loop: {100 * share:.2f} % of the engine's speed")
        self.assertGreater(share, 0.9)


if __name__ == "__main__":
    unittest.main()
