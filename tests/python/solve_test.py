#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Equilibria: bit for bit those of `palpate solve`; failures; threads; Ctrl-C."""

import json
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np
import palpate
from project import BEAM, FOUR_LEG, read_table, run_palpate

# Taut and slack cables, a tension, loads on a patch and on a point.
ACTUATION = """t_s,north.displacement_m,west.displacement_m,east.tension_N
0,0.006,0.001,0.5
1,0.012,0.001,1.5
"""
LOADS = """t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m
0,0,0,0.125,0.1,0,-0.3,0.008
1,0,0,0.125,0.1,0.2,-0.3,0.008
1,0.05,0,0.1,0,0,-0.05,0
"""


def array_of(rows, *columns):
    return np.array([[float(row[column]) for column in columns] for row in rows])


class AgainstTheProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "actuation.csv").write_text(ACTUATION, encoding="utf-8")
            (folder / "loads.csv").write_text(LOADS, encoding="utf-8")
            run_palpate("solve", FOUR_LEG, "--actuation", folder / "actuation.csv", "--loads",
                        folder / "loads.csv", "--out", folder / "out")
            out = folder / "out"
            cls.nodes_m = [array_of(read_table(out / f"nodes_000{row}.csv"), "x_m", "y_m", "z_m")
                           for row in range(2)]
            cables = array_of(read_table(out / "cables.csv"), "displacement_m", "tension_N")
            cls.cables = cables.reshape(2, 4, 2)
            markers = read_table(out / "markers.csv")
            cls.marker_names = [row["marker"] for row in markers]
            cls.markers_m = array_of(markers, "x_m", "y_m", "z_m").reshape(2, -1, 3)
            cls.result = json.loads((out / "result.json").read_text(encoding="utf-8"))
        cls.robot = palpate.Robot(FOUR_LEG)
        tip = cls.robot.patch([0, 0, 0.125], 0.008)
        side = cls.robot.patch([0.05, 0, 0.1])
        first = cls.robot.solve({"north": 0.006, "west": 0.001}, {"east": 0.5},
                                loads=[palpate.Load(tip, [0.1, 0, -0.3])])
        second = cls.robot.solve([0.012, 0.001, np.nan, np.nan], [np.nan, np.nan, np.nan, 1.5],
                                 loads=[palpate.Load(tip, [0.1, 0.2, -0.3]),
                                        palpate.Load(side, [0, 0, -0.05])], start=first)
        cls.found = [first, second]

    def test_nodes_are_the_same_to_the_last_bit(self):
        for found, nodes_m in zip(self.found, self.nodes_m):
            np.testing.assert_array_equal(found.positions_m, nodes_m)

    def test_cables_are_the_same_to_the_last_bit(self):
        for found, cables in zip(self.found, self.cables):
            np.testing.assert_array_equal(found.displacement_m, cables[:, 0])
            np.testing.assert_array_equal(found.tension_N, cables[:, 1])
        self.assertGreater(self.found[0].tension_N[0], 0.0)

    def test_markers_are_the_same_to_the_last_bit(self):
        for found, markers_m in zip(self.found, self.markers_m):
            np.testing.assert_array_equal(found.markers_m, markers_m)
        self.assertEqual(self.marker_names[:len(self.robot.markers)], self.robot.markers)

    def test_so_are_iterations_and_residuals(self):
        for found, row in zip(self.found, self.result["rows"]):
            self.assertEqual(found.iterations, row["iterations"])
            self.assertEqual(found.residual_N, row["residual_N"])

    def test_a_patch_is_where_its_nodes_are(self):
        tip = self.robot.marker("tip")
        mean_m = np.asarray(tip.weights) @ self.found[1].positions_m[tip.nodes]
        np.testing.assert_allclose(self.found[1].position_m(tip), mean_m, rtol=1e-14)
        np.testing.assert_array_equal(self.found[1].position_m(tip), self.found[1].markers_m[0])

    def test_positions_are_a_view_that_cannot_be_written(self):
        positions_m = self.found[0].positions_m
        self.assertTrue(np.shares_memory(positions_m, self.found[0].positions_m))
        self.assertFalse(positions_m.flags.writeable)


class OtherModels(unittest.TestCase):
    def test_gravity_and_moduli_change_the_equilibrium(self):
        robot = palpate.Robot(BEAM)
        at_first = robot.solve()
        robot.gravity_m_s2 = [0.0, 0.0, 0.0]
        np.testing.assert_allclose(robot.solve().positions_m, robot.rest_m, atol=1e-12)
        robot.gravity_m_s2 = [0.0, 0.0, -9.81]
        modulus_Pa = robot.youngs_modulus_Pa()
        robot.set_youngs_modulus("body", 2.0 * modulus_Pa)
        sinks = [(found.positions_m - robot.rest_m)[:, 2].min() for found in
                 (at_first, robot.solve())]
        self.assertGreater(sinks[0] / sinks[1], 1.9)
        robot.set_youngs_modulus("body", modulus_Pa)
        np.testing.assert_allclose(robot.solve().positions_m, at_first.positions_m, atol=1e-15)


class Failures(unittest.TestCase):
    def test_a_load_that_cannot_be_borne_is_said_with_its_status(self):
        robot = palpate.Robot(BEAM)
        tip = robot.patch([0.0, 0.015, 0.03], 0.005)
        with self.assertRaises(palpate.SolveError) as caught:
            robot.solve(loads=[palpate.Load(tip, [-1e6, 0.0, 0.0])])
        self.assertIn(caught.exception.status, ("not_converged", "inverted"))
        self.assertTrue(str(caught.exception))
        self.assertLess(caught.exception.load_fraction, 1.0)
        robot.solve()  # the robot is as good as before


class LongCalls(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = palpate.Robot(FOUR_LEG)

    def test_ctrl_c_ends_them(self):
        """A displacement that cannot be reached takes all load steps, and then is a SolveError."""
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with self.assertRaises(KeyboardInterrupt):
            self.robot.solve({"north": 0.2})
        self.robot.solve({"north": 0.001})  # the robot is as good as before

    def test_other_threads_run_meanwhile(self):
        rounds, done = [0], threading.Event()

        def count():
            while not done.is_set():
                rounds[0] += 1
                time.sleep(0)

        other = threading.Thread(target=count)
        other.start()
        before = rounds[0]
        self.robot.solve({"north": 0.012})
        during = rounds[0] - before
        done.set()
        other.join()
        self.assertGreater(during, 10)

    def test_threads_take_turns_with_one_robot(self):
        alone = self.robot.solve({"north": 0.01})
        found = [None] * 4

        def solve(index):
            found[index] = self.robot.solve({"north": 0.01})

        threads = [threading.Thread(target=solve, args=(index,)) for index in range(len(found))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for one in found:
            np.testing.assert_array_equal(one.positions_m, alone.positions_m)


class Air(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = palpate.Robot("pneumatic_finger")
        cls.less = cls.robot.solve(air_m3={"bend": 0.4e-6})
        cls.more = cls.robot.solve(air_m3={"bend": 0.8e-6}, start=cls.less)

    def test_a_chamber_of_given_air_follows_boyle(self):
        ambient_Pa = 101325.0
        volumes_m3 = []
        for air_m3, found in ((0.4e-6, self.less), (0.8e-6, self.more)):
            pressure_Pa, change_m3 = found.tension_N[0], found.displacement_m[0]
            self.assertGreater(pressure_Pa, 1e3)
            # (p0 + p) (V + dV) = p0 (V + air): V of chamber and tube
            volumes_m3.append((ambient_Pa * air_m3 - (ambient_Pa + pressure_Pa) * change_m3) /
                              pressure_Pa)
        np.testing.assert_allclose(volumes_m3[0], volumes_m3[1], rtol=1e-5)
        self.assertGreater(volumes_m3[0], 1.6e-6)  # the tube's alone

    def test_what_has_no_air_of_its_own_is_refused(self):
        with self.assertRaisesRegex(palpate.InputError, "chamber bend has a pressure or volume"):
            self.robot.solve(tension_N={"bend": 1e3}, air_m3={"bend": 1e-7})
        with self.assertRaisesRegex(palpate.InputError, "cable north is no chamber"):
            palpate.Robot(FOUR_LEG).solve(air_m3={"north": 1e-7})
        with self.assertRaisesRegex(palpate.SolveError, "cannot lose 1 m3 of air"):
            self.robot.solve(air_m3={"bend": -1.0})
        with self.assertRaisesRegex(palpate.InputError, "derivatives are not known"):
            palpate.compliance(self.less)


if __name__ == "__main__":
    unittest.main()
