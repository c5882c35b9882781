#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Two SPDX lines head every source file, after a #!, <?xml or <!doctype line at most."""

import re
import sys

import source_tree
from source_tree import Violation

LINES = ("SPDX-FileCopyrightText: 2026 The palpate authors",
         "SPDX-License-Identifier: Apache-2.0")
SUFFIXES = source_tree.CPP_SUFFIXES | {
    ".c", ".h", ".in", ".py", ".sh", ".cmake", ".yaml", ".yml", ".idl", ".msg", ".xml", ".geo",
    ".cff", ".js", ".mjs", ".css", ".html"}
NAMES = {"CMakeLists.txt", "run", ".clang-format", ".clang-tidy", "Dockerfile"}
FIRST_LINE = re.compile(r"#!|<\?xml|<!doctype")
COMMENT = re.compile(r"^(?://|#|<!--|/\*| \*|%)?\s*(.*?)\s*(?:-->|\*/)?$")


def is_data(path):
    """Measured or computed data, as a program writes them."""
    return path.parts[:2] == ("tests", "data") and path.suffix == ".yaml"


def check_lines(lines):
    """The rule that the head of a file breaks, or ""."""
    start = 1 if lines and FIRST_LINE.match(lines[0]) else 0
    head = [COMMENT.match(line)[1] for line in lines[start:start + 2]]
    return "" if tuple(head) == LINES else "must begin with the two SPDX lines"


def check_tree(root):
    files = [path for path in source_tree.list_files(root)
             if (path.suffix in SUFFIXES or path.name in NAMES) and not is_data(path)]
    violations = []
    for path in files:
        rule = check_lines(source_tree.read_lines(root / path)[:3])
        if rule:
            violations.append(Violation(path.as_posix(), 1, rule))
    return violations, len(files)


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_spdx", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
