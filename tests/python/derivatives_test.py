#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Compliances and sensitivities against differences of equilibria, and their laws."""

import unittest

import numpy as np
import palpate
from project import FOUR_LEG


class AtATautState(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = palpate.Robot(FOUR_LEG)
        cls.commands = {"north": 0.012, "east": 0.010}
        cls.tip = cls.robot.marker("tip")
        cls.side = cls.robot.patch([0.05, 0, 0.1], 0.006)
        cls.found = cls.robot.solve(cls.commands)

    def solve(self, loads=(), **changed):
        return self.robot.solve(changed.get("displacement_m", self.commands),
                                changed.get("tension_N"), loads=loads, start=self.found)

    def test_compliances_are_symmetric_and_reciprocal(self):
        patches = [self.tip, self.side]
        W = palpate.compliance(self.found, observed=patches, loaded=patches)
        self.assertEqual(W.W_ef.shape, (6, 6))
        self.assertEqual(W.W_ea.shape, (6, 4))
        np.testing.assert_allclose(W.W_ef, W.W_ef.T, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(W.W_aa, W.W_aa.T, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(W.W_ea, W.W_af.T, rtol=1e-9, atol=1e-12)
        self.assertGreater(np.linalg.eigvalsh(W.W_aa).min(), 0.0)

    def test_compliance_is_the_derivative_at_fixed_tensions(self):
        tensions_N = dict(zip(self.robot.cables, self.found.tension_N))
        W = palpate.compliance(self.found, observed=[self.tip], loaded=[self.side])
        step_N = 1e-4
        for axis in range(3):
            force_N = np.eye(3)[axis] * step_N
            moved = [self.robot.solve(tension_N=tensions_N, start=self.found,
                                      loads=[palpate.Load(self.side, sign * force_N)])
                     for sign in (1, -1)]
            difference = (moved[0].position_m(self.tip) - moved[1].position_m(self.tip))
            np.testing.assert_allclose(W.W_ef[:, axis], difference / (2 * step_N), rtol=1e-4,
                                       atol=1e-8)

    def test_sensitivities_are_derivatives_of_equilibria(self):
        modulus_Pa = self.robot.youngs_modulus_Pa()
        found = palpate.sensitivity(
            self.found,
            [palpate.Parameter.youngs_modulus(), palpate.Parameter.cable_offset("north"),
             palpate.Parameter.external_force(self.side, [0, 0, 2.0])],
            observed=[self.tip])
        self.assertEqual(found.observed_m.shape, (1, 3, 3))
        self.assertEqual(found.positions_m.shape, (len(self.robot.rest_m), 3, 3))

        def with_modulus(change_Pa):
            self.robot.set_youngs_modulus("body", modulus_Pa + change_Pa)
            solved = self.solve()
            self.robot.set_youngs_modulus("body", modulus_Pa)
            return solved

        def with_offset(change_m):
            return self.solve(displacement_m={"north": 0.012 + change_m, "east": 0.010})

        def with_force(change_N):
            return self.solve([palpate.Load(self.side, [0, 0, change_N])])

        for p, (moved, step) in enumerate(((with_modulus, 10.0), (with_offset, 1e-5),
                                           (with_force, 1e-4))):
            plus, minus = moved(step), moved(-step)
            positions = (plus.positions_m - minus.positions_m) / (2 * step)
            scale = np.abs(positions).max()
            np.testing.assert_allclose(found.positions_m[:, :, p], positions, atol=1e-4 * scale)
            tensions = (plus.tension_N - minus.tension_N) / (2 * step)
            np.testing.assert_allclose(found.tension_N[:, p], tensions,
                                       atol=1e-4 * np.abs(tensions).max())

    def test_what_a_point_does_is_what_its_nodes_do(self):
        found = palpate.sensitivity(self.found, [palpate.Parameter.mass_factor()],
                                    observed=[self.tip])
        nodes = np.einsum("k,kap->ap", self.tip.weights, found.positions_m[self.tip.nodes])
        np.testing.assert_allclose(found.observed_m[0], nodes, rtol=1e-9, atol=1e-15)

    def test_parameters_of_unknown_names_are_refused(self):
        with self.assertRaisesRegex(palpate.InputError, "did you mean"):
            palpate.sensitivity(self.found, [palpate.Parameter.cable_offset("nort")])
        with self.assertRaisesRegex(palpate.InputError, "zero"):
            palpate.Parameter.gravity_turn([0, 0, 0])


if __name__ == "__main__":
    unittest.main()
