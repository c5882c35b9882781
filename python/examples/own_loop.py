#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A loop of one's own: markers, here of a model that is pressed, become forces frame by frame."""

import numpy as np
import palpate

robot = palpate.Robot("four_leg")
place = robot.patch([0.0, 0.0, 0.125], 0.006)
noise_m = 5e-5
random = np.random.default_rng(1)
estimator = palpate.MarkerEstimator(robot, contacts=["hub: 0, 0, 0.125, 0.006"])

# What a tracker would measure: the robot with one cable pulled, at first untouched, which tells the
# offsets of the markers, then pressed more and more.
UNTOUCHED = 30
state = robot.solve({"north": 0.008})
measured, true_N = [state.markers_m] * UNTOUCHED, [np.zeros(3)] * UNTOUCHED
for force_N in np.linspace(0.0, 1.0, 20):
    true_N.append(np.array([0.0, 0.0, -force_N]))
    state = robot.solve({"north": 0.008}, loads=[palpate.Load(place, true_N[-1])], start=state)
    measured.append(state.markers_m)

estimated_N = []
for index, markers_m in enumerate(measured):
    frame = estimator.frame(
        t_s=index / 30.0,
        markers_m=markers_m + random.normal(0.0, noise_m, markers_m.shape),
        displacement_m={"north": 0.008},
        sigma_m=noise_m,
        reference="equilibrium" if index < UNTOUCHED else "none",
    )
    estimate = estimator.update(frame)
    if estimate.usable and estimate.contacts:
        contact = estimate.contacts[0]
        estimated_N.append((index, contact.force_N))
        print(f"{estimate.t_s:5.2f} s  {np.linalg.norm(contact.force_N):.3f} N "
              f"+- {contact.ci95_N:.3f} N  (true {-true_N[index][2]:.3f} N)")
share = sum(force_N[2] for _, force_N in estimated_N) / sum(
    true_N[index][2] for index, _ in estimated_N)
print(f"recovered {share:.3f} of the force")
