#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis hypothesis of one's own: what markers of a rod say of a rubber band at its tip,
which no catalogue has, against a softer body and a heavier one."""

import dataclasses
import typing

import numpy as np
import palpate

COMMANDS = [{name: pull_m} for name in ("up", "down", "left", "right") for pull_m in (0.003, 0.006)]
NOISE_M = 1e-4
BAND_FROM_M = np.array([0.0, 0.06, 0.015])  # where it is tied to the ground, robot frame
TRUE_BAND_N_M = 4.0

robot = palpate.Robot("rod")
tip = robot.patch([0.0, 0.03, 0.015], 0.004)
regions_Pa = {part: robot.youngs_modulus_Pa(part) for part in robot.parts if part != "body"}
gravity_m_s2 = np.array(robot.gravity_m_s2)


def markers_m(command, loads=()):
    return robot.solve(command, loads=loads).markers_m.ravel()


def with_band(command, stiffness_N_m):
    """The band pulls by how far the tip is from where it lies without force: a fixed point."""
    slack_m = np.linalg.norm(robot.solve().position_m(tip) - BAND_FROM_M)
    force_N = np.zeros(3)
    for _ in range(20):
        state = robot.solve(command, loads=[palpate.Load(tip, force_N)])
        along_m = BAND_FROM_M - state.position_m(tip)
        length_m = np.linalg.norm(along_m)
        pull_N = stiffness_N_m * max(0.0, length_m - slack_m) * along_m / length_m
        if np.linalg.norm(pull_N - force_N) < 1e-6:
            break
        force_N = pull_N
    return state.markers_m.ravel()


def with_softer_body(command, log_factor):
    for part, nominal_Pa in regions_Pa.items():
        robot.set_youngs_modulus(part, nominal_Pa * np.exp(log_factor))
    try:
        return markers_m(command)
    finally:
        for part, nominal_Pa in regions_Pa.items():
            robot.set_youngs_modulus(part, nominal_Pa)


def with_heavier_body(command, log_factor):
    robot.gravity_m_s2 = gravity_m_s2 * np.exp(log_factor)
    try:
        return markers_m(command)
    finally:
        robot.gravity_m_s2 = gravity_m_s2


@dataclasses.dataclass
class Hypothesis:
    """One parameter z with a normal prior, and what the markers do."""

    name: str
    unit: str
    sigma: float  # of z before the data
    step: float  # for the derivative
    simulate: typing.Callable[[dict, float], np.ndarray]

    def fit(self, measured_m):
        """z, its standard error, and the logarithm of the evidence (Laplace's approximation)."""
        z = 0.0
        for _ in range(6):  # Gauss and Newton
            at_z = np.concatenate([self.simulate(command, z) for command in COMMANDS])
            beside = np.concatenate([self.simulate(command, z + self.step) for command in COMMANDS])
            slope = (beside - at_z) / self.step / NOISE_M
            residual = (measured_m - at_z) / NOISE_M
            information = slope @ slope + self.sigma**-2
            change = (slope @ residual - z / self.sigma**2) / information
            misfit = residual @ residual + (z / self.sigma) ** 2 - change**2 * information
            z += change
            if abs(change) < 0.05 / np.sqrt(information):
                break
        return z, information**-0.5, -0.5 * (misfit + np.log(information * self.sigma**2))


random = np.random.default_rng(1)
truth_m = np.concatenate([with_band(command, TRUE_BAND_N_M) for command in COMMANDS])
measured_m = truth_m + random.normal(0.0, NOISE_M, truth_m.shape)
nothing_m = np.concatenate([markers_m(command) for command in COMMANDS])
ln_nothing = -0.5 * np.sum(((measured_m - nothing_m) / NOISE_M) ** 2)

hypotheses = [
    Hypothesis("a rubber band at the tip", "N/m", 10.0, 0.05, with_band),
    Hypothesis("a softer body", "in ln E", 0.3, 0.01, with_softer_body),
    Hypothesis("a heavier body", "in ln g", 0.3, 0.01, with_heavier_body),
]
found = []
for hypothesis in hypotheses:
    z, error, ln_evidence = hypothesis.fit(measured_m)
    found.append((ln_evidence - ln_nothing, hypothesis.name))
    print(f"{hypothesis.name}: {z:.3g} +- {error:.2g} {hypothesis.unit}, "
          f"ln Bayes factor {found[-1][0]:.1f} against the robot file")
best, second = sorted(found, reverse=True)[:2]
print(f"named: {best[1]}, ln Bayes factor {best[0] - second[0]:.1f} over {second[1]}")
