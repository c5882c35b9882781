#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Runs tests of the live page with Node's test runner, in Debian's Chromium where --work is given.
Packages of npm are installed in that folder, not in the sources. Skips with the reason where
Chromium, Node, npm or the network is missing."""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent
LOCK = "package-lock.json"
# What npm says where it cannot reach the registry. All else is a fault of the package files.
NO_NETWORK = re.compile(r"EAI_AGAIN|ENOTFOUND|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH"
                        r"|EHOSTUNREACH|ENOTCACHED|ERR_SOCKET_TIMEOUT")


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def need(*programs):
    for program, package in programs:
        if shutil.which(program) is None:
            skip(f"{program} is not installed (Debian package {package})")


def npm(arguments, folder):
    """Runs npm; skips where there is no network."""
    done = subprocess.run(["npm", *arguments, "--no-audit", "--no-fund", "--fetch-retries=1"],
                          cwd=folder, capture_output=True, text=True)
    output = done.stdout + done.stderr
    if done.returncode and NO_NETWORK.search(output):
        skip("npm cannot reach its registry")
    if done.returncode:
        sys.exit(f"npm {' '.join(arguments)} failed:\n{output}")


def install(folder):
    """Copies this folder to where packages may be installed, and installs them if they are not."""
    installed = folder / "node_modules" / LOCK
    ours = (HERE / LOCK).read_bytes()
    shutil.copytree(HERE, folder, dirs_exist_ok=True,
                    ignore=shutil.ignore_patterns("node_modules", "__pycache__"))
    if not installed.exists() or installed.read_bytes() != ours:
        npm(["ci"], folder)
        installed.write_bytes(ours)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", type=pathlib.Path,
                        help="folder for packages; without it the tests need no browser")
    parser.add_argument("--programs", type=pathlib.Path, help="folder of palpate's programs")
    parser.add_argument("tests", nargs="+", help="files of this folder")
    arguments = parser.parse_args()
    need(("node", "nodejs"))
    if arguments.work:
        need(("chromium", "chromium"), ("npm", "npm"))
        install(arguments.work)
    environment = os.environ | {"PALPATE_SOURCE_DIR": str(HERE.parents[3])}
    if arguments.programs:
        environment["PALPATE_PROGRAM_DIR"] = str(arguments.programs.resolve())
    command = ["node", "--test", "--test-concurrency=1", "--test-reporter=spec", *arguments.tests]
    sys.exit(subprocess.run(command, cwd=arguments.work or HERE, env=environment).returncode)


if __name__ == "__main__":
    main()
