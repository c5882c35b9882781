#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Sources that are compiled together (PALPATE_UNITY) have no two things of one name.

What an anonymous namespace holds is its source's own only where each source is compiled by
itself. ./run compiles ten at a time, CI one: this finds in CI what would stop ./run."""

import json
import pathlib
import re
import sys

import source_tree
from source_tree import Violation

TOGETHER = 10  # UNITY_BUILD_BATCH_SIZE of cmake/PalpateOptions.cmake
TARGET = re.compile(r" -o (\S+\.dir)/")
TYPE = re.compile(r"(?:struct|class|enum(?: class)?) (\w+)[^;]*$")
CONSTANT = re.compile(r"(?:inline |static )*const(?:expr)? ")
CONSTANT_NAME = re.compile(r"\b(k[A-Z]\w*)\s*(?:=(?!=)|[{\[(])")
ALIAS = re.compile(r"using (\w+) = (.*);")
FUNCTION = re.compile(r"(?!TEST|INSTANTIATE|BENCHMARK|template|using|return)"
                      r"[A-Za-z][^=;(]*?[\s*&](\w+)\((.*?)\)")


def parameter_types(parameters):
    """"const A& a, int b = 0" -> ("const A&", "int"); commas of template arguments are kept."""
    types, depth, start = [], 0, 0
    for i, letter in enumerate(parameters + ","):
        depth += (letter in "<({") - (letter in ">)}")
        if letter == "," and depth == 0:
            types.append(re.sub(r"\s*\w+\s*(=.*)?$", "", parameters[start:i].strip()))
            start = i + 1
    return tuple(types)


def own_names(lines):
    """(line number, name, what it is) of all that stands in anonymous namespaces; of functions
    and aliases `what` tells those apart that may stand beside each other."""
    inside = False
    for number, line in enumerate(lines, start=1):
        if line in ("namespace {", "}  // namespace"):
            inside = line == "namespace {"
        elif inside and CONSTANT.match(line):
            yield from ((number, name, "constant") for name in CONSTANT_NAME.findall(line))
        elif inside and (match := TYPE.match(line)):
            yield number, match[1], "type"
        elif inside and (match := ALIAS.match(line)):
            yield number, match[1], f"alias of {match[2]}"
        elif inside and (match := FUNCTION.match(" ".join(lines[number - 1:number + 3]))):
            yield number, match[1], f"function of {parameter_types(match[2])}"


def clash(one, other):
    """Whether two declarations of one name, as `what` of own_names, exclude each other."""
    both = {one.split()[0], other.split()[0]}
    if both == {"function"}:
        return one == other
    return both != {"alias"} or one != other


def neighbours(commands, root):
    """Each of the project's own C++ sources with those of its target that CMake may put together
    with it: those before it, so that a source more or less changes nothing."""
    targets = {}
    for entry in commands:
        source = pathlib.Path(entry["file"])
        target = TARGET.search(entry["command"])
        if source.suffix == ".cpp" and source.is_relative_to(root) and target:
            targets.setdefault(target[1], []).append(source.relative_to(root))
    for sources in targets.values():
        for k, source in enumerate(sources):
            yield source, sources[max(0, k + 1 - TOGETHER):k]


def check_source(root, source, others):
    theirs = [(name, what, other) for other in others
              for _, name, what in own_names(source_tree.read_lines(root / other))]
    return [Violation(source.as_posix(), number,
                      f"{name} is a name in {other.as_posix()}, too, which ./run may compile "
                      "together with this")
            for number, name, what in own_names(source_tree.read_lines(root / source))
            for their_name, of_theirs, other in theirs
            if name == their_name and clash(what, of_theirs)]


def check_commands(root, commands):
    violations, checked = [], 0
    for source, others in neighbours(commands, root):
        violations += check_source(root, source, others)
        checked += 1
    return violations, checked


def main():
    parser = source_tree.parse_root(__doc__)
    parser.add_argument("--commands", type=pathlib.Path, required=True,
                        help="compile_commands.json of a build")
    arguments = parser.parse_args()
    commands = json.loads(arguments.commands.read_text(encoding="utf-8"))
    if any("/Unity/" in entry["file"] for entry in commands):
        print("check_unity: this build compiles them together: the compiler has checked it")
        return source_tree.SKIPPED
    return source_tree.report("check_unity", *check_commands(arguments.root.resolve(), commands))


if __name__ == "__main__":
    sys.exit(main())
