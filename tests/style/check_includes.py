#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A source includes, itself or through what it includes, the header of ours that declares what it
names.

./run and CI compile ten sources of a target at a time (PALPATE_UNITY), where a header that one of
them forgets comes with the source before it: this finds it without compiling each by itself."""

import functools
import pathlib
import re
import sys

import source_tree
from source_tree import Violation

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
NO_CODE = re.compile(r'//[^\n]*|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|#include <[^\n]*', re.DOTALL)
# In a namespace nothing is indented.
DECLARED = re.compile(
    r"^(?:struct|class|enum class|enum|using) (\w+)\b(?! *;|::)"
    r"|^(?!using|return|template|namespace)[A-Za-z][\w:<>,&* ]*?[ &*](\w+)\(", re.MULTILINE)
# What a source declares itself, wherever it stands.
OWN = re.compile(
    r"\b(?:struct|class|enum class|enum|using|typename(?:\.\.\.)?|template <std::\w+) (\w+)"
    r"|^ *(?!return|throw|else|case|co_)[A-Za-z~](?:[\w:<>,&* \[\]]|<\w+\([^)]*\)>)*[ &*](\w+)\(",
    re.MULTILINE)
INHERITED = {"Run"}  # from a library's class
MACRO = re.compile(r"^[A-Z_]{4,}\([^)]*\)", re.MULTILINE)
NAMED = re.compile(r"(?<![\w.:>])(?:\w+::)*[A-Z]\w*[a-z]\w*")


def names(pattern, text):
    return {name for match in pattern.findall(text) for name in match if name}


class Tree:
    """The project's C++ files, comments and literals taken out."""

    def __init__(self, root):
        self.files = {}
        self.includes = {}
        for file in source_tree.list_files(root):
            if file.suffix in source_tree.CPP_SUFFIXES:
                text = (root / file).read_text(encoding="utf-8", errors="replace")
                self.includes[file.as_posix()] = INCLUDE.findall(text)
                self.files[file.as_posix()] = NO_CODE.sub(
                    lambda match: "\n" * match[0].count("\n"), text)
        self.headers = {}  # name -> headers that declare it
        self.namespaces = set()
        for file, text in self.files.items():
            self.namespaces.update(re.findall(r"^namespace (?:\w+::)*(\w+)", text, re.MULTILINE))
            if file.endswith(".hpp"):
                for name in names(DECLARED, text):
                    self.headers.setdefault(name, []).append(file)

    @functools.cache
    def words(self, file):
        return frozenset(re.findall(r"\w+", self.files.get(file, "")))

    @functools.cache
    def reached(self, file):
        """Headers of ours that the file includes, itself or through others."""
        found, open_ones = set(), list(self.includes.get(file, []))
        while open_ones:
            header = open_ones.pop()
            if header not in found:
                found.add(header)
                open_ones += self.includes.get(header, [])
        return found

    def check_file(self, file):
        text = MACRO.sub("", self.files[file])
        known = INHERITED | names(OWN, text).union(*map(self.words, self.reached(file)))
        for qualified in sorted(set(NAMED.findall(text))):
            parts = qualified.split("::")
            name = next((part for part in parts if part not in self.namespaces), None)
            if name in self.headers and name not in known and file not in self.headers[name]:
                known.add(name)
                line = self.files[file].count("\n", 0, self.files[file].find(qualified)) + 1
                yield Violation(file, line, f"{name}: include {' or '.join(self.headers[name])}")


def check_tree(root):
    tree = Tree(root)
    violations = [violation for file in tree.files if not file.endswith(".inl")
                  for violation in tree.check_file(file)]
    return violations, len(tree.files)


def main():
    root = source_tree.parse_root(__doc__).parse_args().root.resolve()
    return source_tree.report("check_includes", *check_tree(root))


if __name__ == "__main__":
    sys.exit(main())
