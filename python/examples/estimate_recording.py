#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Forces on a beam from the markers of a recording, with the calibration of palpate calibrate.

usage: estimate_recording.py CALIBRATION.yaml [EXPERIMENT_FOLDER RECORDING [CONTACT ...]]
"""

import pathlib
import sys

import numpy as np
import palpate

SOURCES = pathlib.Path(__file__).resolve().parents[2]
calibration = sys.argv[1]
folder = sys.argv[2] if len(sys.argv) > 2 else str(SOURCES / "tests/data/beam_calculix")
name = sys.argv[3] if len(sys.argv) > 3 else "hung_weight"

experiment = palpate.Experiment(folder)
recording = experiment.recording(name)
robot = palpate.Robot(experiment.robot, calibration)
print(f"{robot.name}: E {robot.youngs_modulus_Pa():.4g} Pa, {len(recording.marker_t_s)} frames")

# Three markers do not tell where the weight hangs, and in which direction it pulls.
contacts = sys.argv[4:] or ["weight: 0, 0.015, 0.03, 0.005 along 0, 0, -1"]
estimator = palpate.MarkerEstimator(robot, recording, contacts=contacts)
begin_s, end_s = recording.steady_window_s
sizes_N = []
for frame in palpate.marker_frames(recording, robot):
    estimate = estimator.update(frame)
    if estimate.usable and begin_s <= estimate.t_s <= end_s:
        sizes_N += [np.linalg.norm(contact.force_N) for contact in estimate.contacts]
print(f"mean force {np.mean(sizes_N):.3f} N in {len(sizes_N)} frames of the static phase")
