# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""What all style checks share: the files of the tree, and how a violation is reported."""

import argparse
import dataclasses
import pathlib
import subprocess
import sys

SKIPPED = 77  # exit code that ctest reads as "skipped"
NOT_OURS = {".git", ".cache", "build", "__pycache__"}
CPP_SUFFIXES = {".cpp", ".hpp", ".inl"}


@dataclasses.dataclass(frozen=True)
class Violation:
    file: str  # relative to the root
    line: int  # from 1; 0: the file as a whole
    rule: str

    def __str__(self):
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{place}: {self.rule}"


def list_files(root):
    """Files of the project, relative paths, sorted: what git tracks or would track; without git
    (a source archive) every file outside build folders."""
    root = pathlib.Path(root)
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others",
               "--exclude-standard"]
    if (root / ".git").exists():
        listed = subprocess.run(command, capture_output=True, check=True).stdout.decode()
        names = {pathlib.Path(name) for name in listed.split("\0") if name}
    else:
        names = {path.relative_to(root) for path in root.rglob("*")}
    return sorted(name for name in names
                  if not NOT_OURS & set(name.parts) and (root / name).is_file())


def read_lines(path):
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def parse_root(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--root", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2],
                        help="folder of the project (default: that of this script)")
    return parser


def report(check, violations, checked):
    """Prints the violations and the closing line; returns the exit code."""
    for violation in violations:
        print(violation)
    print(f"{check}: {len(violations)} violations, {checked} checked")
    if checked == 0:
        print(f"{check}: found nothing to check", file=sys.stderr)
    return 1 if violations or checked == 0 else 0
