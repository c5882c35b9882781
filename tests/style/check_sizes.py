#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes: source files up to 600 lines of up to 100 columns (of C++ check_format.py sees to that),
functions up to 60 lines, READMEs of components up to 80 lines without the rows of tables, any file
below 1 MB; and no trailing white space."""

import re
import sys

import source_tree
from source_tree import Violation

MAX_FILE_LINES = 600
MAX_FUNCTION_LINES = 60
MAX_README_LINES = 80
MAX_COLUMNS = 100
MAX_BYTES = 1_000_000
SOURCE_SUFFIXES = source_tree.CPP_SUFFIXES | {".py", ".cmake", ".idl", ".sh", ".js", ".mjs"}
MADE = "components/view/web/dist"  # minified
SOURCE_NAMES = {"CMakeLists.txt", "run"}

# The last line of a signature ends in ") {" (after qualifiers). Its first line is the one that
# opens that parenthesis. In formatted code the function ends at the first line that is only a
# brace at the indentation of the first line, or farther to the left after the last of several
# initialisers. A single initialiser is no signature, nor is what begins a block of a function.
SIGNATURE_END = re.compile(
    r"[^/]\)(?: const| noexcept| override| final| mutable| -> [\w:<>, *&]+)* \{$")
NO_SIGNATURE = re.compile(r"^\s*(?::|(?:\} )?(?:if|for|while|switch|else|do|catch)\b|\}"
                          r"|(?:namespace|class|struct)\b|/)")


def signature_begin(lines, last):
    """Index of the line that opens the parenthesis which the line `last` closes."""
    depth = 0
    for begin in range(last, -1, -1):
        depth += lines[begin].count(")") - lines[begin].count("(")
        if depth <= 0:
            return begin
    return last


def long_functions(lines):
    """(line, length) of each function that is too long."""
    found = []
    for last, line in enumerate(lines):
        if not SIGNATURE_END.search(line) or NO_SIGNATURE.match(line):
            continue
        begin = signature_begin(lines, last)
        if NO_SIGNATURE.match(lines[begin]):
            continue
        indentation = len(lines[begin]) - len(lines[begin].lstrip())
        end_line = re.compile(rf"\s{{0,{indentation}}}\}}[;,)]*$")
        end = next((i for i in range(last + 1, len(lines)) if end_line.match(lines[i])), last)
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
    """Lines of text: the rows of tables do not count."""
    return sum(not line.startswith("|") for line in lines)


def check_tree(root):
    violations = []
    files = source_tree.list_files(root)
    for path in files:
        name = path.as_posix()
        size = (root / path).stat().st_size
        if size >= MAX_BYTES:
            violations.append(Violation(name, 0, f"{size} bytes, must be below {MAX_BYTES}"))
        if name.startswith(MADE):
            continue
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
