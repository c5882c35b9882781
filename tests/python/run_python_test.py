#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a test of the Python package, or skips it with the reason where the package is not built.

usage: run_python_test.py PACKAGE_FOLDER SOURCE_FOLDER PROGRAM_FOLDER TEST_FILE
"""

import os
import pathlib
import runpy
import sys

SKIPPED = 77  # exit code that ctest reads as "skipped"


def main():
    package, source, programs, test = sys.argv[1:5]
    if not list(pathlib.Path(package, "palpate").glob("_engine*.so")):
        print("skipped: the Python module is not built (pybind11-dev, python3-dev, python3-numpy)")
        return SKIPPED
    sys.path[:0] = [package, str(pathlib.Path(test).parent)]
    os.environ["PYTHONPATH"] = package
    os.environ["PALPATE_SOURCE_DIR"] = source
    os.environ["PALPATE_PROGRAMS"] = programs
    sys.argv = [test]
    runpy.run_path(test, run_name="__main__")
    return 0


if __name__ == "__main__":
    sys.exit(main())
