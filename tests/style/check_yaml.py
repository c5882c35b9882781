#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Every YAML and JSON file of the tree can be read, and no YAML map names a key twice."""

import json
import sys

import yaml

import source_tree
from source_tree import Violation

YAML_SUFFIXES = {".yaml", ".yml", ".cff"}


class StrictLoader(yaml.SafeLoader):
    """SafeLoader keeps the last of two equal keys without a word."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            if key_node.value in seen:
                raise yaml.MarkedYAMLError(problem=f"key '{key_node.value}' is given twice",
                                           problem_mark=key_node.start_mark)
            seen.add(key_node.value)
        return super().construct_mapping(node, deep)


def check_text(name, text):
    try:
        if name.endswith(".json"):
            json.loads(text)
        else:
            yaml.load(text, Loader=StrictLoader)
    except json.JSONDecodeError as error:
        return [Violation(name, error.lineno, error.msg)]
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        return [Violation(name, line, error.problem or "cannot be read")]
    return []


def check_tree(root):
    files = [path for path in source_tree.list_files(root)
             if path.suffix in YAML_SUFFIXES | {".json"} or path.name in (".clang-format",
                                                                          ".clang-tidy")]
    violations = []
    for path in files:
        violations += check_text(path.as_posix(), (root / path).read_text(encoding="utf-8"))
    return violations, len(files)


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_yaml", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
