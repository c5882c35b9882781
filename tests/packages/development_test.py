#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A project outside the sources finds the installed libraries with find_package(palpate).

usage: development_test.py SOURCE_FOLDER BUILD_FOLDER
"""

import pathlib
import sys
import tempfile

from debian_root import run


def main():
    source, build = map(pathlib.Path, sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for component in ("engine", "development"):
            run("cmake", "--install", build, "--component", component, "--prefix", folder / "a")
        (folder / "a").rename(folder / "moved")
        run("cmake", "-S", source / "tests/packages/consumer", "-B", folder / "build", "-G",
            "Ninja", f"-DCMAKE_PREFIX_PATH={folder / 'moved'}", "-DCMAKE_BUILD_TYPE=Debug")
        run("cmake", "--build", folder / "build")
        said = run(folder / "build/consumer", source / "config/robots/four_leg.yaml")
        commands = (folder / "build/build.ninja").read_text(encoding="utf-8")
    print(said)
    if str(source / "libs") in commands or f"-I{source} " in commands:
        raise SystemExit("the installed targets name the folder of the sources")
    return 0 if said == "four_leg: 4 cables, 0 forces\n" else 1


if __name__ == "__main__":
    sys.exit(main())
