#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the recordings of this folder: a clamped silicone beam computed by CalculiX (ccx).

    python3 make_data.py

Needs ccx 2.20 and Python's standard library, takes some minutes, writes recordings/ and truth.yaml
beside itself. The same numbers come out each time (fixed seed). README.md says what they are.
Lengths in m, forces in N.
"""

import pathlib
import random
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MODULUS_PA = 231e3
POISSONS_RATIO = 0.499
DENSITY_KG_M3 = 1070.0
GRAVITY_M_S2 = 9.81
WEIGHT_KG = 0.052
LOWER = (-0.1, 0.0, 0.0)
SIZE = (0.1, 0.03, 0.03)
# Cell boundaries along x, counted from the clamp, whose edges need small cells; then y and z.
STATIONS_M = [1e-3 * v for v in (0, 0.5, 1.2, 2.2, 4, 7, 12, 20, 30, 42, 54, 66, 77, 87, 95, 100)]
CELLS = (len(STATIONS_M) - 1, 8, 8)
STRIP_M = (0.005, 0.00375)  # of the weight's band: on the top face, and down the tip face
STEPS = 10  # equal steps from the held to the hanging shape
RATE_HZ = 20
REFERENCE_FRAMES, STEADY_FRAMES = 21, 29
NOISE_M = 10e-6
SEED = 20190311
STAND_OFF_M = 0.006
BASE_RADIUS_M = 0.005  # a marker turns with the material within this distance of its foot
MARKERS = (  # name, foot on an edge of the tip face, direction in which it stands off
    ("Tip-1", (0.0, 0.015, 0.030), (0, 0, 1)),
    ("Tip-2", (0.0, 0.000, 0.024), (0, -1, 0)),
    ("Tip-3", (0.0, 0.030, 0.006), (0, 1, 0)),
)
CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
MIDDLES = ((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
           (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1))


class Grid:
    """20-node bricks; nodes sit on a lattice of half cells and are known by their lattice index."""

    def __init__(self):
        self.number, self.bricks = {}, []
        for i in range(CELLS[0]):
            for j in range(CELLS[1]):
                for k in range(CELLS[2]):
                    brick = [(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in CORNERS + MIDDLES]
                    self.bricks.append([self.number.setdefault(n, len(self.number) + 1)
                                        for n in brick])

    @staticmethod
    def position(lattice):
        cell, odd = divmod(lattice[0], 2)
        along = 0.5 * (STATIONS_M[cell] + STATIONS_M[cell + odd])
        return (LOWER[0] + along,) + tuple(LOWER[a] + SIZE[a] * lattice[a] / (2 * CELLS[a])
                                           for a in (1, 2))

    @staticmethod
    def band():
        """Faces that carry the weight, as (origin, lattice directions, area in m2)."""
        width, height = SIZE[1] / CELLS[1], SIZE[2] / CELLS[2]
        for j in range(CELLS[1]):
            for i in range(CELLS[0]):
                if STATIONS_M[i] >= SIZE[0] - STRIP_M[0] - 1e-9:
                    yield (2 * i, 2 * j, 2 * CELLS[2]), (0, 1), width * (STATIONS_M[i + 1]
                                                                         - STATIONS_M[i])
            for k in range(CELLS[2] - round(STRIP_M[1] / height), CELLS[2]):
                yield (2 * CELLS[0], 2 * j, 2 * k), (2, 1), width * height

    def weight_forces(self, force_N):
        """{node: downward force} of a uniform dead traction (8-node faces: -1/12 and 1/3)."""
        faces, forces = list(self.band()), {}
        traction = force_N / sum(area for _, _, area in faces)
        for origin, (u, v), area in faces:
            for a in range(3):
                for b in range(3):
                    if (a, b) == (1, 1):
                        continue
                    lattice = list(origin)
                    lattice[u] += a
                    lattice[v] += b
                    share = 1 / 3 if 1 in (a, b) else -1 / 12
                    node = self.number[tuple(lattice)]
                    forces[node] = forces.get(node, 0.0) + traction * area * share
        return forces

    def centre_of_weight(self):
        faces = list(self.band())
        whole = sum(area for _, _, area in faces)
        centre = [0.0, 0.0, 0.0]
        for origin, (u, v), area in faces:
            middle = list(origin)
            middle[u] += 1
            middle[v] += 1
            centre = [c + area / whole * p for c, p in zip(centre, self.position(middle))]
        return tuple(centre)


def write_input(path, grid, weight_N):
    mu = MODULUS_PA / (2 * (1 + POISSONS_RATIO))
    bulk = MODULUS_PA / (3 * (1 - 2 * POISSONS_RATIO))
    with open(path, "w") as out:
        out.write("*NODE, NSET=NALL\n")
        for lattice, number in grid.number.items():
            out.write(f"{number}," + ",".join(f"{v:.12e}" for v in grid.position(lattice)) + "\n")
        out.write("*ELEMENT, TYPE=C3D20R, ELSET=BODY\n")
        for number, brick in enumerate(grid.bricks, 1):
            out.write(f"{number}," + ",".join(map(str, brick[:12])) + ",\n"
                      + ",".join(map(str, brick[12:])) + "\n")
        out.write("*NSET, NSET=CLAMP\n")
        out.writelines(f"{number}\n" for n, number in grid.number.items() if n[0] == 0)
        out.write("*MATERIAL, NAME=SILICONE\n*HYPERELASTIC, NEO HOOKE\n"
                  f"{mu / 2:.9e},{2 / bulk:.9e}\n"
                  f"*DENSITY\n{DENSITY_KG_M3}\n*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE\n"
                  "*BOUNDARY\nCLAMP,1,3\n*STEP, NLGEOM, INC=1000\n*STATIC, DIRECT\n"
                  f"{1 / STEPS},1.\n*DLOAD\nBODY,GRAV,{GRAVITY_M_S2},0.,0.,-1.\n")
        if weight_N > 0.0:
            out.write("*CLOAD\n")
            out.writelines(f"{n},3,{-f:.12e}\n"
                           for n, f in grid.weight_forces(weight_N).items())
        out.write("*NODE PRINT, NSET=NALL\nU\n*END STEP\n")


def solve(grid, weight_N):
    """[{node: (ux, uy, uz)}] after each of the STEPS equal steps of gravity and weight."""
    with tempfile.TemporaryDirectory() as folder:
        write_input(f"{folder}/job.inp", grid, weight_N)
        run = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True)
        if "Job finished" not in run.stdout:
            raise SystemExit("ccx found no equilibrium:\n" + run.stdout[-1500:])
        states = []
        for line in open(f"{folder}/job.dat"):
            row = line.split()
            if line.startswith(" displacements"):
                states.append({})
            elif len(row) == 4:
                states[-1][int(row[0])] = tuple(map(float, row[1:]))
    if len(states) != STEPS:
        raise SystemExit(f"ccx wrote {len(states)} states instead of {STEPS}")
    return states


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def inverse(m):
    def minor(i, j):
        return (m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3]
                - m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3])
    determinant = sum(m[0][j] * minor(0, j) for j in range(3))
    return [[minor(j, i) / determinant for j in range(3)] for i in range(3)]


def rotation_of(rest, moved):
    """Polar rotation (Higham's iteration) of the affine map that fits the points best."""
    count = len(rest)
    middles = [[sum(p[a] for p in points) / count for a in range(3)] for points in (rest, moved)]
    products = [[[sum((q[a] - middles[w][a]) * (p[b] - middles[0][b]) for q, p in zip(side, rest))
                  for b in range(3)] for a in range(3)] for w, side in enumerate((rest, moved))]
    r = times(products[1], inverse(products[0]))
    for _ in range(30):
        s = inverse(r)
        r = [[0.5 * (r[i][j] + s[j][i]) for j in range(3)] for i in range(3)]
    return r


def edge_weights(grid, foot):
    """{node: weight} of a point on an edge of the tip face (three nodes, quadratic)."""
    lattice = [2 * CELLS[0]] + [2 * CELLS[a] * (foot[a] - LOWER[a]) / SIZE[a] for a in (1, 2)]
    along = next(a for a in (1, 2) if 1e-9 < lattice[a] < 2 * CELLS[a] - 1e-9)
    first = min(int(lattice[along] / 2), CELLS[along] - 1) * 2
    s = lattice[along] - first - 1.0
    nodes = [[round(v) for v in lattice] for _ in range(3)]
    for k in range(3):
        nodes[k][along] = first + k
    return dict(zip((grid.number[tuple(n)] for n in nodes),
                    (s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2)))


def marker_positions(grid, state):
    """[(x, y, z)] of MARKERS: a rigid stick on the foot that turns with the material around it."""
    positions = []
    for _, foot, direction in MARKERS:
        near = [(number, grid.position(n)) for n, number in grid.number.items()
                if sum((p - f) ** 2 for p, f in zip(grid.position(n), foot)) <= BASE_RADIUS_M ** 2]
        rest = [p for _, p in near]
        moved = [tuple(x + u for x, u in zip(p, state[n])) for n, p in near]
        turn = rotation_of(rest, moved)
        shift = [sum(w * state[n][a] for n, w in edge_weights(grid, foot).items())
                 for a in range(3)]
        positions.append(tuple(foot[a] + shift[a] + STAND_OFF_M
                               * sum(turn[a][b] * direction[b] for b in range(3))
                               for a in range(3)))
    return positions


def write_recording(name, kind, notes, shapes, noise):
    folder = HERE / "recordings" / name
    folder.mkdir(parents=True, exist_ok=True)
    frames = [shapes[0]] * REFERENCE_FRAMES + shapes[1:-1] + [shapes[-1]] * (STEADY_FRAMES + 1)
    with open(folder / "markers.csv", "w") as out:
        out.write("t_s,marker,x_m,y_m,z_m\n")
        for f, shape in enumerate(frames):
            for (marker, _, _), position in zip(MARKERS, shape):
                seen = ",".join(f"{v + noise.gauss(0.0, NOISE_M):.7f}" for v in position)
                out.write(f"{f / RATE_HZ:.2f},{marker},{seen}\n")
    steady = (len(frames) - STEADY_FRAMES) / RATE_HZ
    (folder / "recording.yaml").write_text(
        f"kind: {kind}\n"
        f"reference: {{window_s: [0, {(REFERENCE_FRAMES - 1) / RATE_HZ:g}], shape: undeformed}}\n"
        f"steady_window_s: [{steady:g}, {(len(frames) - 1) / RATE_HZ:g}]\n"
        f"notes: {notes}\n")


def write_truth(grid, tips):
    force = WEIGHT_KG * GRAVITY_M_S2
    centre = ", ".join(f"{v:.5f}" for v in grid.centre_of_weight())
    (HERE / "truth.yaml").write_text(
        "# What make_data.py put in; no program reads this as input, reports compare with it.\n"
        f"youngs_modulus_Pa: {MODULUS_PA:g}\n"
        f"poissons_ratio: {POISSONS_RATIO}\n"
        f"hung_weight: {{force_N: [0, 0, {-force:.6f}], centre_of_load_m: [{centre}]}}\n"
        "steady_markers_m:  # without noise\n" + "".join(
            f"  {recording}: {{" + ", ".join(
                f"{marker}: [{', '.join(f'{v:.7f}' for v in p)}]"
                for (marker, _, _), p in zip(MARKERS, shape)) + "}\n"
            for recording, shape in tips.items()))


def main():
    grid, noise, tips = Grid(), random.Random(SEED), {}
    held = [tuple(f + STAND_OFF_M * d for f, d in zip(foot, direction))
            for _, foot, direction in MARKERS]
    for name, kind, weight_N, notes in (
            ("hung_weight", "free", WEIGHT_KG * GRAVITY_M_S2,
             "held straight, then let down slowly with a weight on the top tip edge"),
            ("self_weight", "rest", 0.0, "held straight, then let down slowly, no weight")):
        shapes = [held] + [marker_positions(grid, state) for state in solve(grid, weight_N)]
        write_recording(name, kind, notes, shapes, noise)
        tips[name] = shapes[-1]
        print(name, *(f"{m}: ({', '.join(f'{1e3 * v:.3f}' for v in p)}) mm"
                      for (m, _, _), p in zip(MARKERS, shapes[-1])), flush=True)
    write_truth(grid, tips)


if __name__ == "__main__":
    main()
