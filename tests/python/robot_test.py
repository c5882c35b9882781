#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Robots: what a robot file becomes, and that refusals have the program's words."""

import pathlib
import tempfile
import unittest

import numpy as np
import palpate
from project import FOUR_LEG, run_palpate


class RobotFile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = palpate.Robot(FOUR_LEG)

    def test_has_the_names_of_its_file(self):
        self.assertEqual(self.robot.name, "four_leg")
        self.assertEqual(self.robot.cables, ["north", "west", "south", "east"])
        self.assertEqual(self.robot.markers[0], "tip")
        self.assertEqual(self.robot.parts[0], "body")
        self.assertIn(self.robot.mesh_hash, run_palpate("info", FOUR_LEG))

    def test_a_robot_that_comes_with_palpate_is_found_by_its_name(self):
        self.assertEqual(palpate.Robot("four_leg").mesh_hash, self.robot.mesh_hash)

    def test_arrays_are_views_of_the_mesh_that_cannot_be_written(self):
        rest_m = self.robot.rest_m
        self.assertEqual(rest_m.shape[1], 3)
        self.assertEqual(self.robot.cells.shape[1], 10)
        self.assertEqual(self.robot.cells.max() + 1, len(rest_m))
        self.assertIs(rest_m.base, self.robot)
        self.assertTrue(np.shares_memory(rest_m, self.robot.rest_m))
        with self.assertRaises(ValueError):
            rest_m[0, 0] = 1.0

    def test_the_triangles_enclose_the_volume(self):
        corners_m = self.robot.rest_m[self.robot.triangles]
        volume_m3 = np.linalg.det(corners_m).sum() / 6.0
        self.assertAlmostEqual(volume_m3, 0.000302787, delta=1e-8)

    def test_a_view_outlives_its_robot(self):
        rest_m = palpate.Robot(FOUR_LEG).rest_m
        np.testing.assert_array_equal(rest_m, self.robot.rest_m)


class Refusals(unittest.TestCase):
    def refused_text(self, text):
        """Of the four legs' file with `text` in it: what Python and what the program says."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "robot.yaml")
            whole = pathlib.Path(FOUR_LEG).read_text(encoding="utf-8")
            file.write_text(whole + text, encoding="utf-8")
            with self.assertRaises(palpate.InputError) as caught:
                palpate.Robot(str(file))
            return str(caught.exception), run_palpate("info", str(file), allowed=(2,)), str(file)

    def test_a_bad_file_is_refused_in_the_words_of_the_program(self):
        said, by_program, file = self.refused_text("gravitation_m_s2: [0, 0, -9.81]\n")
        self.assertTrue(said.startswith(file + ":"), said)
        self.assertRegex(said, r"robot\.yaml:\d+:\d+: ")
        self.assertIn(said, by_program)

    def test_errors_are_those_of_python_too(self):
        self.assertTrue(issubclass(palpate.InputError, ValueError))
        self.assertTrue(issubclass(palpate.SolveError, palpate.RunError))
        self.assertTrue(issubclass(palpate.RunError, RuntimeError))

    def test_an_unknown_robot_cable_marker_or_part_is_named(self):
        robot = palpate.Robot(FOUR_LEG)
        for call in (
            lambda: palpate.Robot("four_legs"),
            lambda: robot.marker("tipp"),
            lambda: robot.set_youngs_modulus("boddy", 1e5),
            lambda: robot.solve({"nort": 0.001}),
        ):
            with self.assertRaisesRegex(palpate.InputError, "did you mean"):
                call()

    def test_a_part_without_elements_cannot_be_changed(self):
        rod = palpate.Robot("rod")
        for change in (lambda: rod.set_youngs_modulus("body", 1e5),
                       lambda: rod.set_poissons_ratio("body", 0.4)):
            with self.assertRaisesRegex(palpate.InputError,
                                        "'body' of robot rod has no element; give one of root"):
                change()

    def test_numbers_out_of_range_are_refused(self):
        robot = palpate.Robot(FOUR_LEG)
        for call in (
            lambda: robot.set_youngs_modulus("body", 0.0),
            lambda: robot.set_youngs_modulus("body", float("nan")),
            lambda: robot.set_poissons_ratio("body", 0.5),
            lambda: robot.solve([0.001, 0.0]),
            lambda: robot.solve({"north": float("inf")}),
            lambda: robot.solve(tension_N={"north": -1.0}),
            lambda: robot.solve(cable_input="force"),
            lambda: robot.patch([0.0, 0.0, float("nan")]),
            lambda: robot.patch([0.0, 0.0]),
            lambda: robot.patch([0.0, 0.0, 0.1], -1.0),
            lambda: robot.patch([5.0, 0.0, 0.1]),
            lambda: palpate.Load(robot.marker("tip"), [0.0, float("inf"), 0.0]),
            lambda: palpate.Robot(FOUR_LEG, threads=0),
            lambda: palpate.Robot(FOUR_LEG, solver="lu"),
            lambda: setattr(robot, "gravity_m_s2", [0.0, 0.0]),
        ):
            with self.assertRaises(palpate.InputError):
                call()

    def test_what_belongs_to_another_robot_is_refused(self):
        robot, other = palpate.Robot(FOUR_LEG), palpate.Robot(FOUR_LEG)
        with self.assertRaisesRegex(palpate.InputError, "another robot"):
            robot.solve(loads=[palpate.Load(other.marker("tip"), [0, 0, -0.1])])
        with self.assertRaisesRegex(palpate.InputError, "another robot"):
            robot.solve(start=other.solve())
        with self.assertRaisesRegex(palpate.InputError, "another robot"):
            palpate.compliance(robot.solve(), observed=[other.marker("tip")])


if __name__ == "__main__":
    unittest.main()
