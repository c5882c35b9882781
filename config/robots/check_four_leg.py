#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Checks four_leg.msh with CalculiX (ccx), which shares no code with palpate.

Mesh numbers, sag under its own weight, and what one and two pulled cables do: 10-node tets,
geometrically nonlinear, neo-Hookean. Material and cable numbers here are those of four_leg.yaml;
lengths in m, forces in N. Python's standard library only.

    python3 check_four_leg.py [--mesh-file four_leg.msh] [--modulus 100e3]
"""

import argparse
import collections
import math
import pathlib
import subprocess
import tempfile

DENSITY_KG_M3 = 1070.0
POISSONS_RATIO = 0.45
GRAVITY_M_S2 = 9.81
PULL_POINT_M = (0.062, 0.0, 0.0)  # of the east cable; the others follow by quarter turns
ATTACHMENT_M = (0.031, 0.0, 0.090)
TIP_M = (0.0, 0.0, 0.125)
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
FACES = ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))


def read_msh41(path):
    """Corner nodes {tag: (x, y, z)} in m from a file in mm, and cells [(a, b, c, d)]."""
    lines = path.read_text().split("\n")
    at = lines.index("$Nodes") + 1
    nodes, cells = {}, []
    blocks = int(lines[at].split()[0])
    at += 1
    for _ in range(blocks):
        count = int(lines[at].split()[3])
        tags = [int(lines[at + 1 + k]) for k in range(count)]
        for k, tag in enumerate(tags):
            nodes[tag] = tuple(1e-3 * float(v) for v in lines[at + 1 + count + k].split()[:3])
        at += 1 + 2 * count
    at = lines.index("$Elements") + 1
    blocks = int(lines[at].split()[0])
    at += 1
    for _ in range(blocks):
        _, _, kind, count = map(int, lines[at].split())
        for k in range(count):
            if kind == 4:
                cells.append(tuple(map(int, lines[at + 1 + k].split()[1:5])))
        at += 1 + count
    return nodes, cells


def minus(a, b):
    return tuple(u - v for u, v in zip(a, b))


def norm(a):
    return math.sqrt(sum(v * v for v in a))


def volume_m3(corners):
    a, b, c = (minus(p, corners[0]) for p in corners[1:])
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0


def mean_ratio(corners):
    """12 (3 V)^(2/3) / sum of squared edges: 1 for the regular tet, 0 for a flat one."""
    squares = sum(norm(minus(corners[i], corners[j])) ** 2 for i, j in EDGES)
    return 12.0 * (3.0 * volume_m3(corners)) ** (2.0 / 3.0) / squares


def report_mesh(nodes, cells):
    shapes = [[nodes[n] for n in cell] for cell in cells]
    faces = collections.Counter(tuple(sorted(cell[k] for k in f)) for cell in cells for f in FACES)
    surface = {n for face, count in faces.items() if count == 1 for n in face}
    qualities = [mean_ratio(shape) for shape in shapes]
    volume = sum(volume_m3(shape) for shape in shapes)
    print(f"nodes {len(nodes)}, interior {len(nodes) - len(surface)}, tets {len(cells)}")
    print(f"volume {volume * 1e6:.2f} cm3, mass {volume * DENSITY_KG_M3:.4f} kg")
    print(f"mean-ratio quality: worst {min(qualities):.3f}, "
          f"mean {sum(qualities) / len(qualities):.3f}")


def make_quadratic(nodes, cells):
    """Adds the middle of every edge; edge order of C3D10 is that of EDGES."""
    nodes, middles, quadratic = dict(nodes), {}, []
    for cell in cells:
        added = []
        for i, j in EDGES:
            key = tuple(sorted((cell[i], cell[j])))
            if key not in middles:
                middles[key] = max(nodes) + 1 if not middles else last + 1
                last = middles[key]
                nodes[last] = tuple(0.5 * (u + v) for u, v in zip(nodes[key[0]], nodes[key[1]]))
            added.append(middles[key])
        quadratic.append(tuple(cell) + tuple(added))
    return nodes, quadratic


def write_input(path, nodes, cells, modulus_Pa, nodal_forces):
    mu = modulus_Pa / (2.0 * (1.0 + POISSONS_RATIO))
    bulk = modulus_Pa / (3.0 * (1.0 - 2.0 * POISSONS_RATIO))
    with open(path, "w") as out:
        out.write("*NODE, NSET=NALL\n")
        out.writelines(f"{n},{p[0]:.12e},{p[1]:.12e},{p[2]:.12e}\n" for n, p in nodes.items())
        out.write("*ELEMENT, TYPE=C3D10, ELSET=BODY\n")
        for number, cell in enumerate(cells, 1):
            out.write(f"{number}," + ",".join(map(str, cell)) + "\n")
        out.write("*NSET, NSET=FEET\n")
        out.writelines(f"{n}\n" for n, p in nodes.items() if abs(p[2]) < 1e-6)
        out.write("*MATERIAL, NAME=SILICONE\n*HYPERELASTIC, NEO HOOKE\n"
                  f"{mu / 2:.9e},{2 / bulk:.9e}\n"
                  f"*DENSITY\n{DENSITY_KG_M3}\n*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE\n"
                  "*BOUNDARY\nFEET,1,3\n*STEP, NLGEOM, INC=200\n*STATIC\n0.5,1.\n"
                  f"*DLOAD\nBODY,GRAV,{GRAVITY_M_S2},0.,0.,-1.\n")
        if nodal_forces:
            out.write("*CLOAD\n")
            out.writelines(f"{n},{k + 1},{f:.12e}\n" for (n, k), f in nodal_forces.items())
        out.write("*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU\n*END STEP\n")


def solve(nodes, cells, modulus_Pa, nodal_forces):
    """Displacements {node: (ux, uy, uz)} at the end of the step, from ccx."""
    with tempfile.TemporaryDirectory() as folder:
        write_input(f"{folder}/job.inp", nodes, cells, modulus_Pa, nodal_forces)
        run = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True)
        if "Job finished" not in run.stdout:
            raise SystemExit("ccx found no equilibrium:\n" + run.stdout[-1500:])
        rows = [line.split() for line in open(f"{folder}/job.dat")]
    values = [row for row in rows if len(row) == 4 and row[0].isdigit()]
    return {int(row[0]): tuple(map(float, row[1:])) for row in values[-len(nodes):]}


def turned(point, quarter_turns):
    x, y, z = point
    for _ in range(quarter_turns):
        x, y = -y, x
    return (x, y, z)


def barycentric(corners, cells, point):
    """{node: weight} of the cell that holds the point."""
    for cell in cells:
        shape = [corners[n] for n in cell]
        whole = volume_m3(shape)
        weights = [volume_m3(shape[:k] + [point] + shape[k + 1:]) / whole for k in range(4)]
        if min(weights) >= -1e-9:
            return dict(zip(cell, weights))
    raise SystemExit(f"the body does not hold the attachment {point}")


class Cable:
    """A straight cable from the ground to the corners of the cell that holds its attachment."""

    def __init__(self, quarter_turns, corners, cells):
        self.pull = turned(PULL_POINT_M, quarter_turns)
        self.rest = turned(ATTACHMENT_M, quarter_turns)
        self.weights = barycentric(corners, cells, self.rest)
        self.tension_N, self.end = 0.5, self.rest

    def forces(self):
        along = minus(self.pull, self.end)
        scale = self.tension_N / norm(along)
        return {n: tuple(w * scale * v for v in along) for n, w in self.weights.items()}

    def update(self, displacements):
        """Moves the end with its nodes; returns the shortening of the free length in m."""
        moved = [sum(w * displacements[n][k] for n, w in self.weights.items()) for k in range(3)]
        self.end = tuple(r + m for r, m in zip(self.rest, moved))
        return norm(minus(self.rest, self.pull)) - norm(minus(self.end, self.pull))


def pull(nodes, cells, linear_cells, modulus_Pa, quarter_turns, shortening_m):
    """Secant steps on the tensions until every named cable is shorter by `shortening_m`."""
    cables = [Cable(turn, nodes, linear_cells) for turn in quarter_turns]
    before = [(0.0, 0.0)] * len(cables)
    for _ in range(12):
        forces = collections.Counter()
        for cable in cables:
            for n, force in cable.forces().items():
                forces.update({(n, k): f for k, f in enumerate(force)})
        displacements = solve(nodes, cells, modulus_Pa, forces)
        now = [(cable.tension_N, cable.update(displacements)) for cable in cables]
        if max(abs(shortened - shortening_m) for _, shortened in now) < 5e-5:
            return cables, displacements
        for cable, (f0, s0), (f1, s1) in zip(cables, before, now):
            slope = max((s1 - s0) / (f1 - f0), 2e-3) if abs(f1 - f0) > 1e-9 else 1e-2
            cable.tension_N = max(0.0, f1 + (shortening_m - s1) / slope)
        before = now
    raise SystemExit("the cables' tensions were not found")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    here = pathlib.Path(__file__).parent
    parser.add_argument("--mesh-file", type=pathlib.Path, default=here / "four_leg.msh")
    parser.add_argument("--modulus", type=float, default=100e3, help="Young's modulus in Pa")
    arguments = parser.parse_args()
    corners, linear_cells = read_msh41(arguments.mesh_file)
    report_mesh(corners, linear_cells)
    nodes, cells = make_quadratic(corners, linear_cells)
    tip = min(corners, key=lambda n: norm(minus(corners[n], TIP_M)))

    def show(label, displacements):
        u = displacements[tip]
        print(f"{label}: tip moves by ({', '.join(f'{1e3 * v:.2f}' for v in u)}) mm, "
              f"|u| = {1e3 * norm(u):.2f} mm", flush=True)

    show("own weight", solve(nodes, cells, arguments.modulus, {}))
    show("own weight and 0.2 N to the east on the tip",
         solve(nodes, cells, arguments.modulus, {(tip, 0): 0.2}))
    for label, turns in (("east cable 10 mm", (0,)), ("east and north cable 10 mm", (0, 1))):
        cables, displacements = pull(nodes, cells, linear_cells, arguments.modulus, turns, 0.010)
        show(label, displacements)
        print("  tensions", ", ".join(f"{cable.tension_N:.3f} N" for cable in cables), flush=True)


if __name__ == "__main__":
    main()
