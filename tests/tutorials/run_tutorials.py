#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of a tutorial, as a reader types them, in an empty folder.

usage: run_tutorials.py SOURCE_FOLDER PROGRAM_FOLDER TUTORIAL.md
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def script_of(page):
    """The commands of all blocks of a page in one script that stops at the first failure. The
    first block sets the paths, from the repository's folder."""
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    if len(blocks) < 2:
        raise SystemExit(f"{page}: no commands")
    return "set -euxo pipefail\n" + "\n".join(blocks[1:])


def main():
    source, programs, page = map(pathlib.Path, sys.argv[1:4])
    environment = os.environ | {
        "PALPATE": str(source), "PATH": f"{programs}:{os.environ['PATH']}",
        "ROS_DOMAIN_ID": "89"}
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(["bash", "-c", script_of(page)], cwd=folder, env=environment,
                                check=False)
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
