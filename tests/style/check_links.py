#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Markdown: relative links lead to files and folders of the tree, and anchors to headings. Paths of
Markdown files that comments, messages and inline code name from the root exist, too."""

import pathlib
import re
import sys
import unicodedata

import source_tree
from source_tree import Violation

CODE = re.compile(r"`[^`]*`")
LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
HTML_LINK = re.compile(r"\b(?:href|src)=\"([^\"]+)\"")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
ELSEWHERE = re.compile(r"^[a-z][a-z0-9+.-]*:|^//")
ROOTS = ("components", "config", "docs", "findings", "idl", "libs", "tests")
NAMED_PAGE = re.compile(r"(?<![\w./-])((?:%s)/[\w./-]*\.md)\b" % "|".join(ROOTS))
TEXT_SUFFIXES = source_tree.CPP_SUFFIXES | {
    ".cmake", ".idl", ".md", ".msg", ".py", ".sh", ".txt", ".xml", ".yaml", ".yml"}
# Its trees are made up.
NOT_OURS = {"tests/style/style_checks_test.py"}


def anchor_of(heading):
    """The anchor that GitHub gives a heading."""
    text = LINK.sub(lambda link: link[0][link[0].index("[") + 1:link[0].index("]")], heading)
    kept = (c for c in text.lower() if c in " -_" or unicodedata.category(c)[0] in "LN")
    return "".join(kept).replace(" ", "-")


def prose_of(lines):
    """The lines, those of fenced code empty."""
    prose, in_code = [], False
    for line in lines:
        fence = line.lstrip().startswith("```")
        in_code ^= fence
        prose.append("" if fence or in_code else line)
    return prose


def anchors_of(lines):
    anchors, times = set(), {}
    for heading in filter(None, map(HEADING.match, prose_of(lines))):
        anchor = anchor_of(heading[1])
        times[anchor] = times.get(anchor, -1) + 1
        anchors.add(f"{anchor}-{times[anchor]}" if times[anchor] else anchor)
    return anchors


def targets_of(lines):
    """(line number, target) of each link; its text may go on in the next line."""
    text = "\n".join(CODE.sub("", line) for line in prose_of(lines))
    for pattern in (LINK, HTML_LINK):
        for link in pattern.finditer(text):
            yield text.count("\n", 0, link.start(1)) + 1, link[1]


def check_links(root, name, lines):
    for number, target in targets_of(lines):
        if ELSEWHERE.match(target):
            continue
        path, _, anchor = target.partition("#")
        page = (root / name).parent / path if path else root / name
        if not page.exists():
            yield Violation(name.as_posix(), number, f"{target}: there is no such file")
        elif anchor and page.suffix == ".md":
            if anchor not in anchors_of(source_tree.read_lines(page)):
                yield Violation(name.as_posix(), number, f"{target}: there is no such heading")


def check_named_pages(root, name, lines):
    for number, line in enumerate(lines, start=1):
        for page in NAMED_PAGE.findall(LINK.sub("", line)):
            if not (root / page).exists():
                yield Violation(name.as_posix(), number, f"{page}: there is no such file")


def check_tree(root):
    violations, checked = [], 0
    for name in source_tree.list_files(pathlib.Path(root)):
        if name.suffix not in TEXT_SUFFIXES or name.as_posix() in NOT_OURS:
            continue
        lines = source_tree.read_lines(root / name)
        if name.suffix == ".md":
            violations += check_links(root, name, lines)
        violations += check_named_pages(root, name, lines)
        checked += 1
    return violations, checked


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_links", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
