#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""How much E of the measured silicone beam depends on Poisson's ratio, element and mesh.

    python3 near_incompressible_beam.py build/release/bin/palpate ../shared/data/silicone_beam

Calibrates to each of the two recordings (own weight; 52 g hung at the tip) for every combination
and prints E in kPa and the RMS residual of the markers in mm: docs/near_incompressibility.md.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

ROBOTS = pathlib.Path(__file__).resolve().parents[4] / "config/robots"
MESHES = ((12, 4, 4), (10, 3, 3), (7, 2, 2), (3, 1, 1))
RATIOS = ("0.45", "0.49", "0.499", "0.4999")
KINDS = (("tet10", "mean_dilatation"), ("tet10", "pointwise"), ("tet4", "pointwise"))
# As palpate demo imports them: file, name, kind, window held straight, window at rest.
RECORDINGS = (("beam_gravity_V2_a.c3d", "gravity_a", "rest", "0:0.6", "3.3:4.9"),
              ("beam_load52_V2_a.c3d", "load52g_a", "free", "0:0.35", "3.03:4.63"))
LOADS = ("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
         "0,0,0.015,0.03,0,0,-0.510,0.005\n")


def run(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {result.stderr.strip()}")
    return result.stdout


def import_recordings(palpate, data, robot, experiment):
    for file, name, kind, rest, steady in RECORDINGS:
        run(palpate, "import", data / file, "--out", experiment, "--recording", name,
            "--robot", robot, "--kind", kind, "--markers", "Tip-1,Tip-2,Tip-3",
            "--rest-window", rest, "--rest-shape", "undeformed", "--steady-window", steady,
            "--register", "--rate", 10,
            *([] if experiment.exists() else ["--markers-sigma", "1e-5"]))
    (experiment / "recordings/load52g_a/loads.csv").write_text(LOADS)


def write_robot(file, mesh, element, volumetric, ratio):
    text = (ROBOTS / "beam.yaml").read_text()
    for old, new in (("file: beam.msh", f"file: {mesh}"), ("element: tet10", f"element: {element}"),
                     ("poissons_ratio: 0.499",
                      f"poissons_ratio: {ratio}, volumetric: {volumetric}")):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    file.write_text(text)


def fit(palpate, robot, experiment, recording):
    report = json.loads(run(palpate, "calibrate", robot, "--data", experiment,
                            "--recording", recording,
                            "--out", robot.parent / "calibration.yaml", "--json"))
    return report["moduli"][0]["youngs_modulus_Pa"] / 1e3, report["residual_rms_m"] * 1e3


def print_fits(palpate, folder, experiment, mesh, title):
    robot = folder / "robot.yaml"
    for ratio in RATIOS:
        for element, volumetric in KINDS:
            write_robot(robot, mesh, element, volumetric, ratio)
            fits = [fit(palpate, robot, experiment, name) for _, name, *_ in RECORDINGS]
            print(title.ljust(8), element.ljust(7), volumetric.ljust(15), ratio.rjust(7),
                  *(f"  {E:6.1f} {rms:8.3f}" for E, rms in fits), flush=True)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    palpate, data = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        experiment = folder / "experiment"
        import_recordings(palpate, data, ROBOTS / "beam.yaml", experiment)
        print("mesh     element volumetric       nu       own weight         52 g")
        for cells in MESHES:
            mesh = "beam_{}_{}_{}.msh".format(*cells)
            run(sys.executable, ROBOTS / "make_beam.py", "--cells", *cells, "--out", folder / mesh)
            print_fits(palpate, folder, experiment, mesh, "x".join(map(str, cells)))


if __name__ == "__main__":
    main()
