#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that comes with no file, from its mesh to its forces, by the commands that
`palpate new-robot` prints: a tapered finger with two cables.

usage: new_robot_test.py PROGRAM_FOLDER
"""

import csv
import json
import math
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

LENGTH_MM, WIDE_MM, THIN_MM, ACROSS, ALONG = 90.0, 24.0, 16.0, 3, 12
# Kuhn's six tetrahedra of a brick, which fit from brick to brick.
TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
CABLES_MM = {"left": -5.0, "right": 5.0}
ACCEPTED_ERROR = 0.15  # of the force of the steady push


def place(i, j, k):
    """Of a node, mm: it stands on z = 0 and tapers."""
    share = k / ALONG
    width = WIDE_MM + (THIN_MM - WIDE_MM) * share
    return (width * (i / ACROSS - 0.5), width * (j / ACROSS - 0.5), LENGTH_MM * share)


def write_mesh(file):
    number, cells = {}, []
    for i in range(ACROSS):
        for j in range(ACROSS):
            for k in range(ALONG):
                corners = [(i + a, j + b, k + c) for a, b, c in CORNERS]
                for corner in corners:
                    number.setdefault(corner, len(number) + 1)
                cells += [[number[corners[n]] for n in cell] for cell in TETRAHEDRA]
    lines = ["*NODE"]
    lines += [f"{n}, " + ", ".join(f"{v:.9g}" for v in place(*at)) for at, n in number.items()]
    lines.append("*ELEMENT, TYPE=C3D4, ELSET=silicone")
    lines += [f"{n}, " + ", ".join(map(str, cell)) for n, cell in enumerate(cells, 1)]
    file.write_text("\n".join(lines) + "\n")


def run(command, folder, programs):
    words = shlex.split(command)
    words[0] = str(programs / words[0])
    result = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    print(f"$ {command}\n{result.stdout}{result.stderr}", flush=True)
    if result.returncode != 0:
        raise SystemExit(f"exit code {result.returncode}")
    return result.stdout


def is_steady(t_s, push):
    """Whether the ball stands still, by the scenario; all times are those of the experiment."""
    return 4.5 <= t_s - push["frames"][0]["t_s"] <= 5.8


def check_forces(folder):
    with open(folder / "forces.csv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    answer = json.loads(pathlib.Path(str(folder / "exp") + ".answer.json").read_text())
    push = next(r for r in answer["recordings"] if r["name"].endswith("_push"))
    truths = [math.hypot(*f["forces"][0]["force_N"]) for f in push["frames"]
              if is_steady(f["t_s"], push) and f["forces"]]
    found = [math.hypot(*(float(row[f"f{a}_N"]) for a in "xyz")) for row in rows
             if row["contact"] and is_steady(float(row["t_s"]), push)]
    assert truths and len(found) >= 0.8 * len(truths), (len(found), len(truths))
    truth_N, force_N = sum(truths) / len(truths), sorted(found)[len(found) // 2]
    print(f"push: {force_N:.3f} N, truth {truth_N:.3f} N")
    assert abs(force_N - truth_N) <= ACCEPTED_ERROR * truth_N
    false = [row for row in rows if row["contact"] and not row["recording"].endswith("_push")]
    assert not false, f"{len(false)} forces where nothing touches"


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_mesh(folder / "taper.inp")
        cables = " ".join(f"--cable '{name}={x},0,0;{x},0,80'" for name, x in CABLES_MM.items())
        output = run(f"palpate new-robot taper.inp {cables}", folder, programs)
        assert "unit: mm" in output and "flat face at z = 0 mm" in output, output
        commands = re.findall(r"^  (palpate .*)$", output, re.MULTILINE)
        verbs = [command.split()[1] for command in commands]
        assert verbs == ["info", "solve", "simulate", "calibrate", "estimate", "launch"], verbs
        for command in commands[:-1]:
            run(command, folder, programs)
        run(commands[-1] + " --dry-run", folder, programs)
        check_forces(folder / "taper")
    print("from the mesh to its forces")


if __name__ == "__main__":
    main()
