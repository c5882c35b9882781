#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""C++ as clang-format 14 (Debian 12) writes it. --fix rewrites the files."""

import re
import shutil
import subprocess
import sys

import source_tree
from source_tree import Violation

VERSION = "14"  # others wrap lines otherwise
DIFFERENCE = re.compile(r"^(.+?):(\d+):\d+: error: code should be clang-formatted")


def find_clang_format():
    """Path of clang-format of the right version; "" and the reason where there is none."""
    program = shutil.which(f"clang-format-{VERSION}") or shutil.which("clang-format")
    if program is None:
        return "", "clang-format is not installed (apt-get install clang-format)"
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    if f"version {VERSION}." not in text:
        return "", f"clang-format {VERSION} is wanted, this is: {text.strip()}"
    return program, ""


def check_tree(root, program):
    files = [path.as_posix() for path in source_tree.list_files(root)
             if path.suffix in source_tree.CPP_SUFFIXES]
    run = subprocess.run([program, "--dry-run", "--Werror", "--style=file", *files], cwd=root,
                         capture_output=True, text=True, check=False)
    first_line = {}
    for match in map(DIFFERENCE.match, run.stderr.splitlines()):
        if match:
            first_line.setdefault(match[1], int(match[2]))
    if run.returncode != 0 and not first_line:
        raise RuntimeError(f"{program} failed: {run.stderr}")
    rule = "not formatted: clang-format -i, or tests/style/check_format.py --fix"
    return [Violation(file, line, rule) for file, line in sorted(first_line.items())], len(files)


def main():
    parser = source_tree.parse_root(__doc__)
    parser.add_argument("--fix", action="store_true", help="rewrite the files")
    arguments = parser.parse_args()
    program, reason = find_clang_format()
    if not program:
        print(f"check_format: skipped: {reason}")
        return source_tree.SKIPPED
    violations, checked = check_tree(arguments.root, program)
    if arguments.fix:
        files = [violation.file for violation in violations]
        if files:
            subprocess.run([program, "-i", "--style=file", *files], cwd=arguments.root, check=True)
        violations, checked = check_tree(arguments.root, program)
    return source_tree.report("check_format", violations, checked)


if __name__ == "__main__":
    sys.exit(main())
