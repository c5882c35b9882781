#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes: source files up to 400 lines of up to 100 columns (of C++ check_format.py sees to that),
functions up to 60 lines, READMEs of components up to 80 lines without the rows of their parameter
table, any file below 1 MB; and no trailing white space."""

import re
import sys

import source_tree
from source_tree import Violation

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60
MAX_README_LINES = 80
MAX_COLUMNS = 100
MAX_BYTES = 1_000_000
SOURCE_SUFFIXES = source_tree.CPP_SUFFIXES | {".py", ".cmake", ".idl", ".sh"}
SOURCE_NAMES = {"CMakeLists.txt", "run"}

# A function begins with a line that ends in ") {" (after qualifiers); in formatted code its end is
# the first line that is only a brace at the same indentation, or farther to the left after the last
# of several initialisers. A single one is none.
FUNCTION_BEGIN = re.compile(
    r"^(\s*)(?!\s|:|if\b|for\b|while\b|switch\b|else\b|do\b|catch\b|\}"
    r"|namespace\b|class\b|struct\b)[^/].*\)"
    r"(?: const| noexcept| override| final| mutable| -> [\w:<>, *&]+)* \{$")


def long_functions(lines):
    """(line, length) of each function that is too long."""
    found = []
    for begin, line in enumerate(lines):
        match = FUNCTION_BEGIN.match(line)
        if not match:
            continue
        end_line = re.compile(rf"\s{{0,{len(match[1])}}}\}}[;,)]*$")
        end = next((i for i in range(begin + 1, len(lines)) if end_line.match(lines[i])), begin)
        length = end - begin + 1
        if length > MAX_FUNCTION_LINES:
            found.append((begin + 1, length))
    return found


def check_source(name, lines, is_cpp):
    violations = []
    if len(lines) > MAX_FILE_LINES:
        violations.append(Violation(name, 0, f"{len(lines)} lines, at most {MAX_FILE_LINES}"))
    for number, line in enumerate(lines, start=1):
        if not is_cpp and len(line) > MAX_COLUMNS:
            violations.append(Violation(name, number, f"{len(line)} columns, at most "
                                                      f"{MAX_COLUMNS}"))
        if line != line.rstrip():
            violations.append(Violation(name, number, "trailing white space"))
    for number, length in long_functions(lines) if is_cpp else []:
        violations.append(Violation(name, number, f"function of {length} lines, at most "
                                                  f"{MAX_FUNCTION_LINES}"))
    return violations


def readme_length(lines):
    """Without the rows of the parameter table: the program prints them, check_readmes.py fills
    them in."""
    rows = 0
    for start in [i for i, line in enumerate(lines) if line.startswith("| parameter |")]:
        for line in lines[start + 2:]:
            if not line.startswith("|"):
                break
            rows += 1
    return len(lines) - rows


def check_tree(root):
    violations = []
    files = source_tree.list_files(root)
    for path in files:
        name = path.as_posix()
        size = (root / path).stat().st_size
        if size >= MAX_BYTES:
            violations.append(Violation(name, 0, f"{size} bytes, must be below {MAX_BYTES}"))
        if path.suffix in SOURCE_SUFFIXES or path.name in SOURCE_NAMES:
            lines = source_tree.read_lines(root / path)
            violations += check_source(name, lines, path.suffix in source_tree.CPP_SUFFIXES)
        if path.name == "README.md" and path.parts[0] == "components":
            length = readme_length(source_tree.read_lines(root / path))
            if length > MAX_README_LINES:
                violations.append(Violation(name, 0, f"{length} lines, at most "
                                                     f"{MAX_README_LINES}"))
    return violations, len(files)


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_sizes", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
