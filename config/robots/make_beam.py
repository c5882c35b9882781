#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Writes beam.msh (Gmsh 2.2, ASCII, m): a box of bricks, each cut into five tetrahedra.

    python3 make_beam.py [--cells 12 4 4]

Neighbouring bricks are cut as mirror images, so that faces match and no diagonal is preferred.
Bricks are short at the clamp, whose edges are singular, and longer towards the tip.
"""

import argparse
import pathlib

LOWER_M = (-0.1, 0.0, 0.0)
SIZE_M = (0.1, 0.03, 0.03)
GRADING = 1.75  # plane i of n along x lies at (i/n)^GRADING of the length
# Corners of a brick are numbered by the bits of (x, y, z): x is 1, y is 2, z is 4.
EVEN = ((0, 1, 2, 4), (3, 2, 1, 7), (5, 4, 7, 1), (6, 7, 4, 2), (1, 2, 4, 7))


def five_tets(origin, number):
    """The brick at `origin`; odd ones are the mirror image in x (bit 1), order mended."""
    odd = sum(origin) % 2
    for tet in EVEN:
        corners = [corner ^ odd for corner in tet]
        if odd:
            corners[2], corners[3] = corners[3], corners[2]
        yield [number[tuple(origin[a] + (corner >> a & 1) for a in range(3))]
               for corner in corners]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cells", type=int, nargs=3, default=(12, 4, 4))
    parser.add_argument("--out", type=pathlib.Path,
                        default=pathlib.Path(__file__).parent / "beam.msh")
    arguments = parser.parse_args()
    counts = arguments.cells
    lattice = [(i, j, k) for i in range(counts[0] + 1) for j in range(counts[1] + 1)
               for k in range(counts[2] + 1)]
    number = {index: n for n, index in enumerate(lattice, 1)}
    tets = [tet for i in range(counts[0]) for j in range(counts[1]) for k in range(counts[2])
            for tet in five_tets((i, j, k), number)]
    with open(arguments.out, "w") as out:
        out.write('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 "body"\n'
                  f"$EndPhysicalNames\n$Nodes\n{len(lattice)}\n")
        for index, n in number.items():
            share = [index[a] / counts[a] for a in range(3)]
            share[0] **= GRADING
            point = (LOWER_M[a] + SIZE_M[a] * share[a] for a in range(3))
            out.write(f"{n} " + " ".join(f"{v:.10g}" for v in point) + "\n")
        out.write(f"$EndNodes\n$Elements\n{len(tets)}\n")
        out.writelines(f"{n} 4 2 1 1 {' '.join(map(str, tet))}\n" for n, tet in enumerate(tets, 1))
        out.write("$EndElements\n")


if __name__ == "__main__":
    main()
