#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""What a new user does with a finger of one's own and motion capture, by README's own commands:
forces within their interval, none at rest, the place on the outer face; a message for each mistake.

usage: markers_test.py SOURCE_FOLDER PROGRAM_FOLDER
"""

import csv
import math
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

import finger

NOISE_M, CONSTANT_ERROR_M, RATE_HZ, SEED = 0.0002, 0.0003, 100, 37
REST_S, RAMP_S, HOLD_S = 0.8, 0.5, 1.5


def in_capture(robot_m):
    """From the robot's frame to one with y up, turned by 30 degrees about y and moved."""
    x, y, z = robot_m[0], robot_m[2], -robot_m[1]
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    return (c * x + s * z + 0.30, y + 0.10, -s * x + c * z - 0.20)


class Capture:
    """Writes captures: at rest, then on the way to a state, then in it."""

    def __init__(self, states):
        self.states = states
        self.random = random.Random(SEED)
        self.error_m = {name: [self.random.gauss(0.0, CONSTANT_ERROR_M) for _ in range(3)]
                        for name in finger.MARKERS_M}

    def write(self, file, state, frame=in_capture, metres=1.0, rename=None):
        rest = self.states["rest"]
        rows = ["time_s,marker,x_m,y_m,z_m"]
        for k in range(round((REST_S + RAMP_S + HOLD_S) * RATE_HZ)):
            share = min(1.0, max(0.0, (k / RATE_HZ - REST_S) / RAMP_S))
            for name in finger.MARKERS_M:
                at = frame([(1 - share) * p + share * q + e
                            for p, q, e in zip(rest[name], self.states[state][name],
                                               self.error_m[name])])
                noisy = (metres * (v + self.random.gauss(0.0, NOISE_M)) for v in at)
                rows.append(f"{k / RATE_HZ:.2f},{(rename or {}).get(name, name)},"
                            + ",".join(f"{v:.6f}" for v in noisy))
        file.write_text("\n".join(rows) + "\n")


def readme_command(readme, verb):
    """The first command of a verb in README's section about one's own robot."""
    section = readme.split("## Your own robot")[1].split("\n## ")[0]
    found = re.search(rf"`(palpate {verb} [^`]*)`", section)
    if not found:
        raise SystemExit(f"README has no `palpate {verb} ...`")
    return " ".join(found[1].split())


class User:
    def __init__(self, folder, readme, programs):
        self.folder, self.readme = folder, readme
        self.environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}"}

    def run(self, command, exit_code=0, message=""):
        result = subprocess.run(command, shell=True, cwd=self.folder, env=self.environment,
                                capture_output=True, text=True, check=False)
        output = result.stdout + result.stderr
        print(f"$ {command}\n{output}", flush=True)
        if result.returncode != exit_code or not re.search(message, output):
            raise SystemExit(f"expected exit {exit_code} and '{message}', got exit "
                             f"{result.returncode}")
        return output

    def bring(self, capture, recording, kind, experiment="exp", more="", **expected):
        command = readme_command(self.readme, "import")
        for word, value in (("CAPTURE.c3d", capture), ("EXP", experiment), ("NAME", recording),
                            ("KIND", kind), ("ROBOT.yaml", "finger.yaml"),
                            ("0:0.5", f"0:{REST_S - 0.01}")):
            command = command.replace(word, value)
        return self.run(f"{command} {more}".strip(), **expected)

    def calibrate(self, experiment="exp"):
        return self.run(readme_command(self.readme, "calibrate").replace("ROBOT", "finger")
                        .replace("EXP", experiment))

    def estimate(self, out, experiment="exp", more="", **expected):
        command = readme_command(self.readme, "estimate").replace("ROBOT", "finger")
        command = command.replace("EXP", experiment).replace("forces.csv", out)
        return self.run(f"{command} {more}".strip(), **expected)

    def forces(self, file, recording):
        with open(self.folder / file, encoding="utf-8") as table:
            return [row for row in csv.DictReader(table) if row["recording"] == recording]


def is_steady(row):
    return float(row["t_s"]) >= REST_S + RAMP_S


def check_forces(user):
    at_rest = user.forces("forces.csv", "r1_rest")
    found = [row for row in at_rest if row["contact"]]
    assert len(found) <= 2, f"{len(found)} of {len(at_rest)} frames at rest have a force"
    steady = [row for row in user.forces("forces.csv", "r3_push") if is_steady(row)]
    assert len(steady) >= 140, len(steady)
    covered, places = 0, []
    for row in steady:
        assert row["contact"], row
        force_N = math.hypot(*(float(row[f"f{a}_N"]) for a in "xyz"))
        covered += abs(force_N - finger.PUSH_N) <= float(row["ci95_N"])
        places.append([float(row[f"{a}_m"]) for a in "xyz"])
    print(f"force within its interval in {covered} of {len(steady)} frames")
    assert covered >= 0.9 * len(steady), covered
    place_m = [statistics.median(place[a] for place in places) for a in range(3)]
    return place_m, places


def write_loads(experiment):
    x, y, z = finger.WEIGHT_AT_M
    start = REST_S + RAMP_S
    (experiment / "recordings/r2_weight/loads.csv").write_text(
        "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
        f"0,{x},{y},{z},0,0,0,0.0056\n{start},{x},{y},{z},{-finger.WEIGHT_N},0,0,0.0056\n")


def check_right_use(user, capture, truth_m):
    capture.write(user.folder / "rest.csv", "rest")
    capture.write(user.folder / "weight.csv", "weight")
    capture.write(user.folder / "push.csv", "push")
    user.run("palpate info finger.yaml", message="faces of closed cavities left out")
    user.bring("rest.csv", "r1_rest", "rest", message="rest shape: equilibrium under gravity")
    user.bring("weight.csv", "r2_weight", "known_load",
               more=f"--steady-window {REST_S + RAMP_S}:{REST_S + RAMP_S + HOLD_S}")
    write_loads(user.folder / "exp")
    user.bring("push.csv", "r3_push", "free")
    settings = (user.folder / "exp/experiment.yaml").read_text(encoding="utf-8")
    assert "markers_sigma_m" in settings, settings
    user.calibrate()
    user.estimate("forces.csv")
    place_m, places = check_forces(user)
    off_m = math.dist(place_m, truth_m)
    print(f"place {place_m} is {1e3 * off_m:.1f} mm from the truth {truth_m}")
    assert off_m <= 0.005, off_m
    inner = sum(place[1] - truth_m[1] < -finger.WALL_M / 2 for place in places)
    assert inner == 0, f"{inner} places are on the hollow's wall"


def check_mistakes(user, capture):
    # The body was not held straight.
    user.bring("rest.csv", "r1_rest", "rest", experiment="straight", more="--rest-shape undeformed")
    user.estimate("straight.csv", experiment="straight", exit_code=1,
                  message="Likely reasons: 1\\) rest shape")
    # The capture's frame is not the robot's.
    command = readme_command(user.readme, "import").replace(" --register", " --frame robot")
    for word, value in (("CAPTURE.c3d", "rest.csv"), ("EXP", "wrong"), ("NAME", "r1_rest"),
                        ("KIND", "rest"), ("ROBOT", "finger"), ("0:0.5", "0:0.7")):
        command = command.replace(word, value)
    user.run(command, exit_code=2, message="turned by .* degrees: they are not in the robot frame")
    # The same, believed by hand after the import.
    shutil.copytree(user.folder / "exp", user.folder / "by_hand")
    for file in (user.folder / "by_hand").rglob("recording.yaml"):
        text = re.sub(r"^T_robot_camera:.*\n(?: .*\n)*", "", file.read_text(), flags=re.MULTILINE)
        file.write_text(re.sub(r"^frame: camera", "frame: robot", text, flags=re.MULTILINE))
    user.estimate("by_hand.csv", experiment="by_hand", exit_code=2, message="turned by .* degrees")
    # Two labels are exchanged.
    capture.write(user.folder / "exchanged.csv", "rest", rename={"m1_x": "m3_y", "m3_y": "m1_x"})
    user.bring("exchanged.csv", "r1_rest", "rest", experiment="wrong", exit_code=2,
               message="'m1_x' and 'm3_y' look exchanged|'m3_y' and 'm1_x' look exchanged")
    # Millimetres in columns of metres.
    capture.write(user.folder / "mm.csv", "rest", metres=1e3)
    user.bring("mm.csv", "r1_rest", "rest", experiment="wrong", exit_code=2, message="unit")
    # A name that the robot does not have.
    capture.write(user.folder / "name.csv", "rest", rename={"m0_x": "m0_z"})
    user.bring("name.csv", "r1_rest", "rest", experiment="wrong", exit_code=2,
               message="did you mean")
    # No registration.
    command = command.replace(" --frame robot", "").replace("wrong", "unplaced")
    user.run(command, message="its pose in the robot's frame is not known")
    user.estimate("unplaced.csv", experiment="unplaced", exit_code=2, message="T_robot_camera")
    assert not (user.folder / "wrong").exists()


def surface_place(states):
    """Where the patch's centre is on the pushed finger: between the markers around it, by the
    motion of those at the same height on the other faces."""
    lower, upper = (finger.MARKERS_M[f"m{k}_y"][2] for k in (1, 2))
    share = (finger.PUSH_AT_M[2] - lower) / (upper - lower)
    axis = [[(1 - share) * p + share * q
             for p, q in zip(states["push"][f"m1_{side}"], states["push"][f"m2_{side}"])]
            for side in ("x", "y")]
    # From the middle of the -y face through the axis to the +y face: twice the half width.
    centre = [axis[0][0] - 0.010, axis[0][1], axis[0][2]]
    return [2 * c - y for c, y in zip(centre, axis[1])]


def main():
    source, programs = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        finger.write_robot(folder)
        states = finger.equilibria(folder)
        user = User(folder, (source / "README.md").read_text(encoding="utf-8"), programs)
        capture = Capture(states)
        check_right_use(user, capture, surface_place(states))
        check_mistakes(user, capture)
    print("as README promises")


if __name__ == "__main__":
    main()
