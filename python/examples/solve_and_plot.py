#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Pulls one cable of the four legs in steps, and plots where the tip goes and the deformed robot.

usage: solve_and_plot.py [PICTURE]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
import palpate

robot = palpate.Robot("four_leg")
tip = robot.marker("tip")
pulled_m = np.linspace(0.0, 0.012, 7)
equilibria = []
for displacement_m in pulled_m:
    start = equilibria[-1] if equilibria else None
    equilibria.append(robot.solve({"north": displacement_m}, start=start))
path_m = np.array([found.position_m(tip) for found in equilibria])
print(f"tip moved by {1e3 * np.linalg.norm(path_m[-1] - path_m[0]):.2f} mm")

figure = plt.figure(figsize=(10, 4))
plot = figure.add_subplot(1, 2, 1)
plot.plot(1e3 * pulled_m, 1e3 * (path_m - path_m[0]), label=["x", "y", "z"])
plot.set_xlabel("displacement of cable north, mm")
plot.set_ylabel("tip displacement, mm")
plot.legend()
scene = figure.add_subplot(1, 2, 2, projection="3d")
x, y, z = equilibria[-1].positions_m.T
scene.plot_trisurf(x, y, z, triangles=robot.triangles, linewidth=0.1)
scene.set_aspect("equal")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "solve_and_plot.png", dpi=120)
