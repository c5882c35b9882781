#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Who may include whom (docs/architecture.md), checked on every #include line; and no circle of
includes between the folders of a library or component."""

import collections
import dataclasses
import graphlib
import pathlib
import re
import sys

import source_tree
from source_tree import Violation

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")')

# Which libraries of ours each library may include, besides itself.
LIBRARIES = {
    "core": set(),
    "app": {"core"},
    "linalg": {"core"},
    "geometry": {"core", "linalg"},
    "plot": {"core"},
    "rgbd": {"core", "geometry"},
    "correspondence": {"core", "geometry", "fem", "robot", "rgbd"},
    "experiment": {"core", "geometry", "rgbd"},
    "recording": {"core"},
    "scenario": {"core", "geometry", "fem", "robot", "rgbd"},
    "gige_vision": {"core", "rgbd"},
    "fem": {"core", "linalg", "geometry"},
    "robot": {"core", "linalg", "geometry", "fem"},
    "security": {"core"},
    "dds": {"core", "geometry", "rgbd", "security"},
    "monitor": {"core", "dds"},
}
# Which folders of a component each of its folders may include, besides itself and its subfolders.
# Files at the component's top join the folders. A component without an entry: no circles, only.
COMPONENT_LAYERS = {
    "view": {
        "picture": set(),
        "plot": {"picture"},
        "frames": set(),
        "serve": set(),
        "foxglove": {"frames"},
        "robot": {"frames"},
        "experiment": {"robot"},
        "node": {"frames", "serve", "foxglove", "robot", "experiment"},
    },
    "diagnosis": {
        "vocabulary": set(),
        "data": set(),
        "forward": {"vocabulary", "data"},
        "surface": {"data", "forward"},
        "faults": {"vocabulary", "data", "forward"},
        "prepare": {"vocabulary", "data", "forward", "surface", "faults"},
        "inference": {"vocabulary", "data", "forward"},
        "design": {"vocabulary", "data", "forward", "inference"},
        "explain": {"vocabulary", "data", "inference"},
        "report": {"vocabulary"},
    },
}
# Components that join the algorithms of others. The command may use all; offline has what the
# command and the Python package do with files.
JOINS = {
    "offline": {"calibration", "force_estimation", "perception"},
    "palpate": {"calibration", "capture", "diagnosis", "force_estimation", "motion_capture",
                "offline", "perception", "player", "recorder", "view", "virtual_camera",
                "virtual_robot"},
}
NOT_FOR_ALGORITHMS = {"app", "dds", "monitor"}
# The Python module has algorithms and settings files, as the command palpate has.
NOT_FOR_PYTHON = {"dds", "monitor"}

# Third-party headers that stay behind one library: pattern, libraries, what to use instead.
THIRD_PARTY = [
    (re.compile(r"yaml-cpp/"), {"app"}, "yaml-cpp only in libs/app: take a ConfigLoader"),
    (re.compile(r"CLI/"), {"app"}, "CLI11 only in libs/app: use app::Arguments"),
    (re.compile(r"spdlog/"), {"app"}, "spdlog only in libs/app: nodes use libs/app/log.hpp"),
    (re.compile(r"(?:suitesparse/|SuiteSparse|cholmod|umfpack|amd\.h|colamd\.h|camd\.h|ccolamd|spqr"
                r"|klu\.h|Eigen/(?:Cholmod|UmfPack|KLU|SPQR)Support)"),
     {"fem"}, "SuiteSparse only in libs/fem: use fem::SparseSolver"),
    (re.compile(r"tinyxml2"), {"fem", "dds"}, "tinyxml2 only in libs/fem and libs/dds"),
    (re.compile(r"zstd|libdeflate"), {"recording"}, "zstd and libdeflate only in libs/recording"),
    (re.compile(r"lz4"), {"recording", "fem"}, "lz4 only in libs/recording and libs/fem"),
    (re.compile(r"lzma"), {"fem"}, "lzma only in libs/fem"),
    (re.compile(r"sqlite3\.h"), {"recording"},
     "SQLite only in libs/recording: use RecordedMessages"),
    (re.compile(r"openssl/"), {"security"}, "OpenSSL only in libs/security"),
    (re.compile(r"png\.h"), {"rgbd"}, "libpng only in libs/rgbd: use rgbd/png.hpp"),
    (re.compile(r"jpeglib\.h"), {"rgbd"}, "libjpeg only in libs/rgbd: use rgbd/jpeg.hpp"),
]
# Third-party headers that stay behind one component.
OF_COMPONENTS = [
    (re.compile(r"pcl/"), "perception", "PCL only in components/perception"),
    (re.compile(r"boost/"), "view", "Boost only in components/view: use WebServer"),
    (re.compile(r"arv\.h|glib"), "capture", "Aravis only in components/capture: use FrameSource"),
]
# The virtual bench's truth: whoever estimates must not see it.
TRUTH = re.compile(r"\bk(?:True\w+|BenchState)Topic\b|\"/truth/")
KNOW_TRUTH = {"virtual_robot", "virtual_camera"}
# Files that only compare: `palpate demo` and the view show estimates beside the truth, and send
# nothing to those who estimate.
COMPARE_WITH_TRUTH = re.compile(
    r"components/(?:palpate/node/demo/live_listener|view/node/\w+)\.cpp$")
PYTHON_HEADER = re.compile(r"pybind11/|Python\.h")
DDS_HEADER = re.compile(r"(?:dds|ddsc)/")


@dataclasses.dataclass(frozen=True)
class Place:
    """Where a file stands: libs/fem, components/view, components/view/node, idl, tests."""
    kind: str  # library | algorithm | node | python | idl | tests | other
    name: str = ""


def place_of(path):
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] == "libs" and len(parts) > 2:
        return Place("library", parts[1])
    if parts[0] == "components" and len(parts) > 2:
        return Place("node" if parts[2] == "node" else "algorithm", parts[1])
    if parts[0] in ("idl", "tests", "python"):
        return Place(parts[0])
    return Place("other")


def check_library(source, target):
    if target == source.name:
        return ""
    if source.kind == "library":
        if source.name not in LIBRARIES:
            return f"libs/{source.name} is not in the table of tests/style/check_layers.py"
        if target not in LIBRARIES[source.name]:
            allowed = ", ".join(sorted(LIBRARIES[source.name])) or "nothing"
            return f"libs/{source.name} may include {allowed}, not libs/{target}"
    if source.kind == "python" and target in NOT_FOR_PYTHON:
        return f"libs/{target} not in python/: it has no DDS"
    if source.kind == "algorithm" and target in NOT_FOR_ALGORITHMS:
        if source.name == "palpate" and target == "app":
            return ""
        return f"libs/{target} only in node/ of a component, not in the algorithm"
    return ""


def check_component(source, target):
    if source.kind == "library":
        return "a library includes no component"
    if source.kind == "python":
        if target.kind == "node" or target.name == "palpate":
            return "python/ includes algorithms of components, neither nodes nor the command"
        return ""
    own = source.name == target.name
    if not own and target.name not in JOINS.get(source.name, ()):
        allowed = ", ".join(sorted(JOINS))
        return f"no component includes another (these excepted: {allowed})"
    if source.kind == "algorithm" and target.kind == "node":
        return "an algorithm does not include a node"
    return ""


def check_dds(source):
    if source.kind in ("node", "idl") or source == Place("library", "dds"):
        return ""
    return "DDS and IDL only in libs/dds and node/ of a component"


def check_third_party(source, header):
    if PYTHON_HEADER.match(header) and source.kind != "python":
        return "pybind11 only in python/"
    for pattern, libraries, rule in THIRD_PARTY:
        inside = source.kind == "library" and source.name in libraries
        if pattern.match(header) and not inside:
            return rule
    for pattern, component, rule in OF_COMPONENTS:
        inside = source.kind in ("algorithm", "node") and source.name == component
        if pattern.match(header) and not inside:
            return rule
    return ""


def check_truth(path, source, line):
    if source.kind in ("tests", "other") or source == Place("library", "dds"):
        return ""
    if COMPARE_WITH_TRUTH.match(path):
        return ""
    if source.name in KNOW_TRUTH or not TRUTH.search(line):
        return ""
    return "only the virtual bench (and tests) may know a /truth topic"


def check_include(source, header, quoted, messages):
    """The rule that `source` breaks by including `header`, or ""."""
    if source.kind in ("tests", "other"):
        return ""
    if DDS_HEADER.match(header) or header.startswith("idl/") or header in messages:
        return check_dds(source)
    target = place_of(header)
    if quoted and target.kind == "library":
        return check_library(source, target.name)
    if quoted and target.kind in ("algorithm", "node"):
        return check_component(source, target)
    if quoted and target.kind == "tests":
        return "only tests include tests"
    if quoted and target.kind == "python":
        return "" if source.kind == "python" else "only python/ includes python/"
    third_party = check_third_party(source, header)
    if third_party or not quoted or source.kind == "idl":
        return third_party
    return 'our headers are included from the root ("libs/..."), others in angle brackets'


def layer_of(path):
    """The layer of a file within its library or component, or None outside of both: its folder, or
    for a file at the top the file, as the vocabulary of all folders and what joins them both stand
    there."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] not in ("libs", "components") or len(parts) < 3:
        return None
    return parts[:2], "/".join(parts[2:-1] or parts[2:])


def check_component_layers(path, header):
    """The rule of COMPONENT_LAYERS that `path` breaks by including `header`, or ""."""
    source, target = (pathlib.PurePosixPath(one).parts for one in (path, header))
    if len(source) < 4 or source[0] != "components" or source[:2] != target[:2]:
        return ""
    layers = COMPONENT_LAYERS.get(source[1])
    if layers is None or source[2] == "node":
        return ""
    own = "/".join(source[:3])
    if source[2] not in layers:
        return f"{own} is not in COMPONENT_LAYERS of tests/style/check_layers.py"
    folder = target[2] if len(target) > 3 else "the component's top"
    if folder == source[2] or folder in layers[source[2]]:
        return ""
    allowed = ", ".join(sorted(layers[source[2]])) or "nothing else of its component"
    return f"{own} may include {allowed}, not {folder}"


def check_circles(includes):
    """`includes`: (file, line, header) of our own. One violation for each library or component
    with a circle, at an include that closes it."""
    layers = collections.defaultdict(dict)  # library or component -> (layer, layer) -> include
    for file, line, header in includes:
        source, target = layer_of(file), layer_of(header)
        if source and target and source[0] == target[0] and source[1] != target[1]:
            layers[source[0]].setdefault((source[1], target[1]), (file, line))
    for edges in layers.values():
        sorter = graphlib.TopologicalSorter()
        for source, target in edges:
            sorter.add(source, target)
        try:
            sorter.prepare()
        except graphlib.CycleError as error:
            circle = error.args[1]  # each is included by the one after it
            file, line = edges[circle[1], circle[0]]
            yield Violation(file, line, "folders are layers; these include each other in a circle: "
                            + " -> ".join(reversed(circle)))


def message_headers(files):
    """What idlc and idl/CMakeLists.txt make of idl/<package>/msg/<Name>.idl."""
    stems = [path.relative_to("idl").with_suffix("") for path in files
             if path.parts[0] == "idl" and path.suffix == ".idl"]
    return {f"{stem.as_posix()}{suffix}" for stem in stems for suffix in (".h", ".hpp")}


def check_tree(root):
    files = source_tree.list_files(root)
    messages = message_headers(files)
    sources = [path for path in files
               if path.suffix in source_tree.CPP_SUFFIXES | {".c", ".h", ".in"}]
    violations = []
    includes = []
    for path in sources:
        source = place_of(path.as_posix())
        for number, line in enumerate(source_tree.read_lines(root / path), start=1):
            rule = check_truth(path.as_posix(), source, line)
            if rule:
                violations.append(Violation(path.as_posix(), number, rule))
            match = INCLUDE.match(line)
            if not match:
                continue
            header = match[1] or match[2]
            includes.append((path.as_posix(), number, header))
            rule = (check_include(source, header, match[2] is not None, messages)
                    or check_component_layers(path.as_posix(), header))
            if rule:
                violations.append(Violation(path.as_posix(), number, f'"{header}": {rule}'))
    return violations + list(check_circles(includes)), len(sources)


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_layers", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
