#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""READMEs of components: the seven headings; the parameter table as the program itself prints it
(--print-config --markdown); topics, types and QoS as config/topics.yaml has them. --fix rewrites
the parameter tables."""

import pathlib
import re
import subprocess
import sys

import yaml

import source_tree
from source_tree import Violation

HEADINGS = ["Purpose", "Inputs", "Outputs", "Parameters", "Limits", "Run", "Test"]
PARAMETER_HEAD = "| parameter |"
TOPIC_SECTIONS = ("Inputs", "Outputs")


def find_sections(lines):
    """[(heading, index of its line, index after its last line)] of the "## " headings."""
    starts = [i for i, line in enumerate(lines) if line.startswith("## ")]
    ends = starts[1:] + [len(lines)]
    return [(lines[start][3:].strip(), start, end) for start, end in zip(starts, ends)]


def check_headings(name, sections):
    found = [heading for heading, _, _ in sections]
    if found == HEADINGS:
        return []
    return [Violation(name, 0, f"headings must be {', '.join(HEADINGS)}; found "
                               f"{', '.join(found) or 'none'}")]


def split_row(line):
    """Cells of a markdown table row; a | in a cell is written \\|."""
    return [cell.strip().replace("\\|", "|")
            for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


def topic_rows(lines, start, end):
    """(line number, {column: cell}) of each row of the tables whose first column is "topic"."""
    columns = None
    for index in range(start, end):
        if not lines[index].startswith("|"):
            columns = None
            continue
        cells = split_row(lines[index])
        if columns is None:
            columns = [cell.lower() for cell in cells]
        elif columns[0] == "topic" and not set(lines[index]) <= set("|-: "):
            yield index + 1, dict(zip(columns, cells))


def same_type(cell, wanted):
    """`sensor_msgs/msg/JointState` may be shortened to `sensor_msgs/JointState` or a bare name."""
    words = re.findall(r"\w+", cell)
    package, _, name = wanted.split("/")
    return [word for word in words if word != "msg"] in ([package, name], [name])


def check_topic_row(cells, topics):
    """The rules that one row of a topic table breaks."""
    name = cells["topic"].strip("`")
    topic = topics.get(name)
    if topic is None:
        return [f"topic {name} is not in config/topics.yaml"]
    rules = []
    if not same_type(cells.get("type", ""), topic["type"]):
        rules.append(f"type of {name} must be {topic['type']}")
    qos = cells.get("qos", "").lower().replace("-", "_").replace(" ", "_")
    for key in ("reliability", "durability"):
        others = {other[key] for other in topics.values()} - {topic[key]}
        if topic[key] not in qos or any(other in qos for other in others):
            rules.append(f"QoS of {name} must say {topic[key]}")
    numbers = re.findall(r"\d+", qos)
    if numbers and str(topic["depth"]) not in numbers:
        rules.append(f"QoS of {name} must say depth {topic['depth']}")
    return rules


def check_topics(name, lines, sections, topics):
    violations = []
    for heading, start, end in sections:
        if heading not in TOPIC_SECTIONS:
            continue
        for number, cells in topic_rows(lines, start, end):
            violations += [Violation(name, number, rule)
                           for rule in check_topic_row(cells, topics)]
    return violations


def find_parameter_table(lines):
    """(first, after last) line index of the parameter table, or None."""
    start = next((i for i, line in enumerate(lines) if line.startswith(PARAMETER_HEAD)), None)
    if start is None:
        return None
    end = start
    while end < len(lines) and lines[end].startswith("|"):
        end += 1
    return start, end


def print_parameters(program):
    run = subprocess.run([str(program), "--print-config", "--markdown"], capture_output=True,
                         text=True, check=False, timeout=30)
    if run.returncode != 0:
        raise RuntimeError(f"{program} --print-config --markdown: {run.stderr.strip()}")
    return run.stdout.splitlines()


def check_parameters(name, lines, printed):
    table = find_parameter_table(lines)
    if table is None:
        return [Violation(name, 0, "the parameter table is missing: check_readmes.py --fix, below "
                                   f'a line "{PARAMETER_HEAD}"')]
    start, end = table
    if lines[start:end] == printed:
        return []
    first = next((i for i, pair in enumerate(zip(lines[start:end], printed)) if pair[0] != pair[1]),
                 min(end - start, len(printed)))
    rule = ("differs from --print-config --markdown: "
            "check_readmes.py --fix --programs build/release/bin")
    return [Violation(name, start + first + 1, rule)]


def fix_parameters(path, lines, printed):
    table = find_parameter_table(lines)
    if table is not None and lines[table[0]:table[1]] != printed:
        lines[table[0]:table[1]] = printed
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_topics(root):
    table = root / "config" / "topics.yaml"
    if not table.exists():
        return {}
    topics = yaml.safe_load(table.read_text(encoding="utf-8"))["topics"]
    return {topic["name"]: topic for topic in topics}


def check_component(root, folder, topics, programs, fix):
    readme = root / folder / "README.md"
    name = (folder / "README.md").as_posix()
    if not readme.exists():
        return [Violation(name, 0, "is missing")]
    lines = source_tree.read_lines(readme)
    program_name = "palpate-" + folder.name.replace("_", "-")
    has_program = folder.name != "palpate" and (root / folder / "node" / "main.cpp").exists()
    violations = []
    if has_program and programs is not None:
        printed = print_parameters(programs / program_name)
        if fix:
            fix_parameters(readme, lines, printed)
        violations += check_parameters(name, lines, printed)
    sections = find_sections(lines)
    return violations + check_headings(name, sections) + check_topics(name, lines, sections, topics)


def check_tree(root, programs, fix=False):
    topics = read_topics(root)
    folders = sorted({pathlib.Path(*path.parts[:2]) for path in source_tree.list_files(root)
                      if path.parts[0] == "components" and path.suffix == ".cpp"})
    violations = []
    for folder in folders:
        violations += check_component(root, folder, topics, programs, fix)
    return violations, len(folders)


def main():
    parser = source_tree.parse_root(__doc__)
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of the built programs; without it parameter tables are not "
                             "compared")
    parser.add_argument("--fix", action="store_true", help="rewrite the parameter tables")
    arguments = parser.parse_args()
    violations, checked = check_tree(arguments.root, arguments.programs, arguments.fix)
    return source_tree.report("check_readmes", violations, checked)


if __name__ == "__main__":
    sys.exit(main())
