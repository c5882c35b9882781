#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Markdown: sentences of up to 25 words, lines of up to 120 characters, and none of the words that
docs/glossary.md replaces. Tables, headings and code do not count. --table prints the mean number of
words of a sentence, file by file."""

import pathlib
import re
import sys

import source_tree
from source_tree import Violation

MAX_WORDS = 25
MAX_COLUMNS = 120
# Of docs/glossary.md, those that have no other sense.
REPLACED = re.compile(
    r"\b(told|nobody|anew|looked at|gives way|give way|believed in|is believed)\b", re.IGNORECASE)
NOT_OURS = {"LICENSE.md"}
CODE = re.compile(r"`[^`]*`")
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.)\s+")
SENTENCE_END = re.compile(r";\s+|(?<=[.!?:])[)\"*_]*\s+(?=[\"(*_`\[]*[A-Z0-9`\[])")


def paragraphs(lines):
    """(line number, text) of each paragraph and item of a list."""
    number, words, in_code = 0, [], False
    for index, line in enumerate(lines, start=1):
        fence = line.lstrip().startswith("```")
        in_code ^= fence
        ends = (fence or in_code or not line.strip() or line.startswith(("#", "|", "    ", "<!--"))
                or ITEM.match(line))
        if ends and words:
            yield number, " ".join(words)
            words = []
        if fence or in_code or not line.strip() or line.startswith(("#", "|", "    ", "<!--")):
            continue
        if not words:
            number = index
        words.append(ITEM.sub("", line).strip())
    if words:
        yield number, " ".join(words)


def sentences(lines):
    """(line number of its paragraph, words) of each sentence."""
    for number, text in paragraphs(lines):
        text = LINK.sub(r"\1", CODE.sub("Code", text))
        for sentence in SENTENCE_END.split(text):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if words:
                yield number, words


def check_file(name, lines):
    in_code = False
    for number, line in enumerate(lines, start=1):
        in_code ^= line.lstrip().startswith("```")
        if len(line) > MAX_COLUMNS and not in_code and not line.startswith(("|", "![")):
            yield Violation(name, number, f"{len(line)} columns, at most {MAX_COLUMNS}")
    for number, words in sentences(lines):
        if len(words) > MAX_WORDS:
            yield Violation(name, number, f"a sentence of {len(words)} words, at most {MAX_WORDS}: "
                                          f"\"{' '.join(words[:6])} ...\"")
        for match in REPLACED.findall(" ".join(words)):
            yield Violation(name, number, f"\"{match}\": docs/glossary.md has the term")


def markdown_files(root):
    return [path for path in source_tree.list_files(root)
            if path.suffix == ".md" and path.name not in NOT_OURS]


def open_part(path, lines):
    """Of a changelog, what is not released yet."""
    if path.name != "CHANGELOG.md":
        return lines
    heads = [i for i, line in enumerate(lines) if line.startswith("## ")]
    return lines[:heads[1]] if len(heads) > 1 else lines


def check_tree(root):
    violations = []
    files = markdown_files(root)
    for path in files:
        lines = open_part(path, source_tree.read_lines(root / path))
        violations += check_file(path.as_posix(), lines)
    return violations, len(files)


def print_table(root):
    print("| file | sentences | words per sentence |\n|---|---|---|")
    for path in markdown_files(root):
        counts = [len(words) for _, words in sentences(source_tree.read_lines(root / path))]
        if counts:
            print(f"| {path.as_posix()} | {len(counts)} | {sum(counts) / len(counts):.1f} |")


def main():
    parser = source_tree.parse_root(__doc__)
    parser.add_argument("--table", action="store_true", help="print words per sentence instead")
    arguments = parser.parse_args()
    if arguments.table:
        print_table(arguments.root)
        return 0
    return source_tree.report("check_prose", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
