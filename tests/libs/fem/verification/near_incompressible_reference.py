#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The deflections that near_incompressible_test.cpp compares with, from CalculiX (`ccx` on PATH).

    python3 near_incompressible_reference.py [--refine 1]

C3D20R on bricks that shrink towards the clamp, small strain: another program, element and mesh.
Prints one row for each body and Poisson's ratio. --refine 2 halves the bricks: the difference tells
how far the row has converged.
"""

import argparse
import pathlib
import re
import subprocess
import tempfile

RATIOS = (0.45, 0.49, 0.499, 0.4999)
# Corners of C3D20R, then the middles of its edges, in half bricks from the lowest corner.
CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
         (0, 4), (1, 5), (2, 6), (3, 7))
END_FACE = (1, 2, 5, 6, 9, 13, 17, 18)  # of a brick, at its greatest x: corners, middles


class Body:
    """Bricks of the unit cube, moved by `place`; held by `held(share) -> directions`; on the end
    x = 1 a uniform shear traction whose sum is `force_N` in `direction`; watched at `probe`."""

    def __init__(self, bricks, grading, place, volume_m3, modulus_Pa, held, force_N, direction,
                 probe):
        self.bricks, self.grading, self.place = bricks, grading, place
        self.volume_m3 = volume_m3
        self.modulus_Pa, self.held = modulus_Pa, held
        self.force_N, self.direction, self.probe = force_N, direction, probe

    def share(self, index):
        """Where a half-brick index lies in the unit cube; bricks near x = 0 are smaller."""
        share = [index[a] / (2 * self.bricks[a]) for a in range(3)]
        share[0] **= self.grading
        return share


def cantilever(length_over_height, refine):
    """The half y > 0 of a beam; 3 E I / L^3 times L / 100 at its end, so that a slender one
    sinks by a hundredth of its length."""
    height, length, modulus = 0.025, 0.025 * length_over_height, 180e3
    force = 3 * modulus * height**4 / 12 / length**3 * length / 100

    def held(share):
        return "xyz" if share[0] == 0 else "y" if share[1] == 0 else ""

    bricks = (16 * refine, 4 * refine, 8 * refine)
    return Body(bricks, 2.0, lambda s: (length * s[0], height / 2 * s[1], height * s[2]),
                length * height**2 / 2, modulus, held, -force / 2, 3, (1, 0, 0.5))


def cook(refine):
    """Cook's membrane in plane strain, thickness 1, shear force 1; corner (48, 60) is at (1, 1)."""

    def held(share):
        return "xyz" if share[0] == 0 else "z"

    bricks = (24 * refine, 24 * refine, 1)
    return Body(bricks, 1.5,
                lambda s: (48 * s[0], 44 * (s[0] + s[1]) - 28 * s[0] * s[1], s[2]),
                48 * (44 + 16) / 2, 1.0, held, 1.0, 2, (1, 0.5, 0))


def brick_nodes(origin):
    corners = [tuple(2 * origin[a] + corner[a] for a in range(3)) for corner in CORNERS]
    middles = [tuple((corners[p][a] + corners[q][a]) // 2 for a in range(3)) for p, q in EDGES]
    return corners + middles


def end_loads(body, cells):
    """Consistent nodal forces: a face of eight nodes takes -1/12 on corners, 1/3 on middles."""
    loads = {}
    faces = [cell for cell in cells if cell[1][0] == 2 * body.bricks[0]]
    for cell in faces:
        for k, local in enumerate(END_FACE):
            weight = -1 / 12 if k < 4 else 1 / 3
            loads[cell[local]] = loads.get(cell[local], 0) + weight * body.force_N / len(faces)
    return loads


def write_deck(body, ratio, file):
    nx, ny, nz = body.bricks
    cells = [brick_nodes((i, j, k)) for i in range(nx) for j in range(ny) for k in range(nz)]
    number = {}
    for cell in cells:
        for index in cell:
            number.setdefault(index, len(number) + 1)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{n}," + ",".join(f"{v:.12e}" for v in body.place(body.share(index)))
              for index, n in number.items()]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=BODY")
    for n, cell in enumerate(cells, 1):
        names = [str(number[index]) for index in cell]
        lines += [f"{n}," + ",".join(names[:10]) + ",", ",".join(names[10:])]
    lines += ["*MATERIAL, NAME=SOLID", "*ELASTIC", f"{body.modulus_Pa},{ratio}",
              "*SOLID SECTION, ELSET=BODY, MATERIAL=SOLID", "*BOUNDARY"]
    lines += [f"{n},{'xyz'.index(axis) + 1}" for index, n in number.items()
              for axis in body.held(body.share(index))]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{number[index]},{body.direction},{force:.12e}"
              for index, force in end_loads(body, cells).items()]
    probe = tuple(round(2 * body.bricks[a] * body.probe[a]) for a in range(3))
    lines += ["*NSET, NSET=PROBE", str(number[probe]), "*NSET, NSET=CLAMP"]
    lines += [str(n) for index, n in number.items() if body.share(index)[0] == 0]
    lines += ["*NODE PRINT, NSET=PROBE", "U", "*NODE PRINT, NSET=CLAMP, TOTALS=ONLY", "RF",
              "*EL PRINT, ELSET=BODY, TOTALS=ONLY", "EVOL", "*END STEP"]
    file.write_text("\n".join(lines) + "\n")


def check_read_back(body, text):
    """ccx drops what goes beyond 20 characters of a number without a word: the volume and the force
    at the clamp show what it read."""
    force = re.search(r"total force[^\n]*CLAMP[^\n]*\n\s*(\S+)\s+(\S+)\s+(\S+)", text)
    volume = re.search(r"total volume[^\n]*\n\s*(\S+)", text)
    for name, read, written in (("force", -float(force[body.direction]), body.force_N),
                                ("volume", float(volume[1]), body.volume_m3)):
        if abs(read - written) > 1e-5 * abs(written):
            raise SystemExit(f"ccx has read another {name}: {read} instead of {written}")


def deflection_m(body, ratio):
    with tempfile.TemporaryDirectory() as folder:
        write_deck(body, ratio, pathlib.Path(folder) / "job.inp")
        subprocess.run(["ccx", "-i", "job"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        text = (pathlib.Path(folder) / "job.dat").read_text()
    check_read_back(body, text)
    row = re.findall(r"^\s*\d+\s+(\S+)\s+(\S+)\s+(\S+)\s*$", text, re.MULTILINE)[-1]
    return float(row[body.direction - 1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--refine", type=int, default=1)
    refine = parser.parse_args().refine
    bodies = {"cantilever 4:1, end, mm": (cantilever(4, refine), -1e3),
              "cantilever 20:1, end, mm": (cantilever(20, refine), -1e3),
              "Cook's membrane, (48, 52)": (cook(refine), 1.0)}
    print("body".ljust(28) + "".join(f"nu {ratio}".rjust(12) for ratio in RATIOS))
    for name, (body, scale) in bodies.items():
        values = (scale * deflection_m(body, ratio) for ratio in RATIOS)
        print(name.ljust(28) + "".join(f"{value:12.5f}" for value in values), flush=True)


if __name__ == "__main__":
    main()
