#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share: where things are, and the C++ program."""

import csv
import os
import pathlib
import subprocess

SOURCE = pathlib.Path(os.environ["PALPATE_SOURCE_DIR"])
PROGRAMS = pathlib.Path(os.environ["PALPATE_PROGRAMS"])
BEAM = str(SOURCE / "config/robots/beam.yaml")
FOUR_LEG = str(SOURCE / "config/robots/four_leg.yaml")
BEAM_DATA = str(SOURCE / "tests/data/beam_calculix")


def run_palpate(*arguments, allowed=(0,)):
    """What `palpate` says on both outputs; fails for another exit code."""
    done = subprocess.run([PROGRAMS / "palpate", *arguments], capture_output=True, text=True)
    if done.returncode not in allowed:
        raise AssertionError(f"exit code {done.returncode}: {done.stderr}")
    return done.stdout + done.stderr


def read_table(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
