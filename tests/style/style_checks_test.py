#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A planted violation of each rule is found, and sound code passes."""

import json
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

import check_decompositions
import check_format
import check_includes
import check_layers
import check_links
import check_prose
import check_readmes
import check_references
import check_sizes
import check_spdx
import check_yaml
import source_tree

HERE = pathlib.Path(__file__).resolve().parent


class TreeTest(unittest.TestCase):
    """Each test plants files in a tree of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def plant(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    def rules(self, violations):
        return "\n".join(map(str, violations))


class CheckLayers(TreeTest):
    def broken(self, path, include):
        """The violations of a tree whose one source holds one include, as text."""
        self.plant("idl/sensor_msgs/msg/JointState.idl", "")
        file = self.plant(path, f"// head\n#include {include}\n")
        violations, _ = check_layers.check_tree(self.root)
        file.unlink()
        return self.rules(violations)

    def assert_broken(self, path, include, words):
        found = self.broken(path, include)
        self.assertIn(f"{path}:2: ", found, (path, include))
        self.assertIn(words, found)

    def test_libraries_include_only_what_comes_before_them(self):
        self.assertEqual(self.broken("libs/fem/a.cpp", '"libs/geometry/b.hpp"'), "")
        self.assertEqual(self.broken("libs/robot/a.cpp", '"libs/fem/mesh_io/b.hpp"'), "")
        self.assert_broken("libs/fem/a.cpp", '"libs/robot/b.hpp"', "not libs/robot")
        self.assert_broken("libs/core/a.hpp", '"libs/geometry/b.hpp"', "may include nothing")
        self.assert_broken("libs/robot/a.cpp", '"libs/app/yaml.hpp"', "not libs/app")
        self.assert_broken("libs/new/a.cpp", '"libs/core/b.hpp"', "not in the table")
        self.assert_broken("libs/core/a.cpp", '"components/view/b.hpp"', "no component")

    def test_the_python_module_has_algorithms_and_settings_and_no_dds(self):
        bindings = "python/bindings/a.cpp"
        self.assertEqual(self.broken(bindings, '"libs/app/yaml.hpp"'), "")
        self.assertEqual(self.broken(bindings, '"components/calibration/b.hpp"'), "")
        self.assertEqual(self.broken(bindings, '"python/bindings/b.hpp"'), "")
        self.assertEqual(self.broken(bindings, "<pybind11/numpy.h>"), "")
        self.assert_broken(bindings, '"libs/dds/b.hpp"', "no DDS")
        self.assert_broken(bindings, "<dds/dds.h>", "only in libs/dds and node/")
        self.assert_broken(bindings, '"components/view/node/b.hpp"', "neither nodes")
        self.assert_broken(bindings, '"components/palpate/b.hpp"', "nor the command")
        self.assert_broken("libs/fem/a.cpp", '"python/bindings/b.hpp"', "only python/")
        self.assert_broken("libs/fem/a.cpp", "<pybind11/numpy.h>", "pybind11 only in python/")

    def test_algorithms_know_neither_app_nor_dds_nor_messages(self):
        algorithm = "components/view/a.cpp"
        self.assertEqual(self.broken(algorithm, '"libs/robot/b.hpp"'), "")
        self.assertEqual(self.broken(algorithm, '"components/view/b.hpp"'), "")
        self.assert_broken(algorithm, '"libs/app/log.hpp"', "only in node/")
        self.assert_broken(algorithm, '"libs/dds/b.hpp"', "only in node/")
        self.assert_broken(algorithm, "<dds/dds.h>", "only in libs/dds and node/")
        self.assert_broken(algorithm, '"sensor_msgs/msg/JointState.hpp"', "only in libs/dds")
        self.assert_broken(algorithm, '"components/view/node/b.hpp"', "does not include a node")
        self.assert_broken(algorithm, '"components/player/b.hpp"', "no component includes another")

    def test_nodes_may(self):
        node = "components/view/node/a.cpp"
        for include in ('"libs/app/log.hpp"', '"libs/dds/b.hpp"', '"components/view/b.hpp"',
                        '"sensor_msgs/msg/JointState.hpp"', "<dds/dds.h>"):
            self.assertEqual(self.broken(node, include), "", include)
        self.assert_broken(node, '"components/player/node/b.hpp"', "no component includes another")

    def test_the_command_may_use_every_algorithm(self):
        command = "components/palpate/solve.cpp"
        self.assertEqual(self.broken(command, '"components/view/b.hpp"'), "")
        self.assertEqual(self.broken(command, '"libs/app/verbs.hpp"'), "")
        self.assert_broken(command, '"libs/dds/b.hpp"', "only in node/")

    def test_third_party_stays_behind_its_library(self):
        for library, include in (("app", "<yaml-cpp/yaml.h>"), ("app", "<CLI/App.hpp>"),
                                 ("app", "<spdlog/spdlog.h>"), ("fem", "<cholmod.h>"),
                                 ("fem", "<suitesparse/cholmod.h>"), ("fem", "<tinyxml2.h>"),
                                 ("fem", "<Eigen/CholmodSupport>"), ("dds", "<dds/dds.h>")):
            self.assertEqual(self.broken(f"libs/{library}/a.cpp", include), "", include)
            self.assert_broken("libs/robot/a.cpp", include, "only in libs/")
        self.assert_broken("components/view/node/a.cpp", "<spdlog/spdlog.h>", "only in libs/app")
        self.assertEqual(self.broken("tests/libs/fem/a.cpp", "<cholmod.h>"), "")

    def test_aravis_stays_in_capture(self):
        for path in ("components/capture/a.cpp", "components/capture/node/a.cpp", "tests/a.cpp"):
            self.assertEqual(self.broken(path, "<arv.h>"), "", path)
        self.assert_broken("libs/gige_vision/a.cpp", "<arv.h>", "only in components/capture")

    def test_no_estimator_knows_the_truth(self):
        line = "reader(participant.CreateReader(dds::kTrueForcesTopic)),\n"
        for path in ("components/force_estimation/node/a.cpp", "libs/robot/a.cpp"):
            file = self.plant(path, line)
            self.assertIn(f"{path}:1: only the virtual bench",
                          self.rules(check_layers.check_tree(self.root)[0]))
            file.write_text('reader("/truth/mesh_state");\n', encoding="utf-8")
            self.assertIn("only the virtual bench",
                          self.rules(check_layers.check_tree(self.root)[0]))
            file.unlink()
        for path in ("components/virtual_camera/node/a.cpp", "tests/system/a.cpp",
                     "components/palpate/node/demo/live_listener.cpp"):
            self.plant(path, line)
        self.assertEqual(check_layers.check_tree(self.root)[0], [])
        self.plant("components/palpate/node/demo/a.cpp", line)
        self.assertIn("only the virtual bench", self.rules(check_layers.check_tree(self.root)[0]))

    def test_our_headers_are_included_from_the_root(self):
        self.assert_broken("libs/fem/a.cpp", '"tet_mesh.hpp"', "from the root")
        self.assert_broken("libs/fem/a.cpp", '"tests/libs/fem/b.hpp"', "only tests include tests")

    def test_folders_of_a_component_include_what_their_table_allows(self):
        self.plant("components/diagnosis/data/a.hpp", "")
        self.plant("components/diagnosis/diagnose.hpp",
                   '#include "components/diagnosis/data/a.hpp"\n')
        self.plant("components/diagnosis/forward/b.hpp",
                   '#include "components/diagnosis/data/a.hpp"\n')
        self.assertEqual(self.rules(check_layers.check_tree(self.root)[0]), "")
        self.plant("components/diagnosis/report/figures/c.hpp",
                   '#include "components/diagnosis/data/a.hpp"\n')
        self.assertIn("report may include vocabulary, not data",
                      self.rules(check_layers.check_tree(self.root)[0]))
        self.plant("components/diagnosis/report/figures/c.hpp",
                   '#include "components/diagnosis/diagnose.hpp"\n')
        self.assertIn("not the component's top", self.rules(check_layers.check_tree(self.root)[0]))
        self.plant("components/diagnosis/report/figures/c.hpp", "")
        self.plant("components/diagnosis/other/d.hpp",
                   '#include "components/diagnosis/data/a.hpp"\n')
        self.assertIn("is not in COMPONENT_LAYERS",
                      self.rules(check_layers.check_tree(self.root)[0]))

    def test_folders_of_a_component_are_layers(self):
        self.plant("components/player/scene.hpp", "")
        self.plant("components/player/ink/line.hpp", '#include "components/player/scene.hpp"\n')
        self.plant("components/player/view.cpp", '#include "components/player/ink/line.hpp"\n')
        self.plant("components/player/ink/fill.cpp", '#include "components/player/ink/line.hpp"\n')
        self.assertEqual(self.rules(check_layers.check_tree(self.root)[0]), "")

    def test_folders_do_not_include_each_other_in_a_circle(self):
        self.plant("components/player/ink/line.hpp", '#include "components/player/txt/glyph.hpp"\n')
        self.plant("components/player/txt/glyph.hpp", '#include "components/player/paper.hpp"\n')
        self.plant("components/player/paper.hpp", '#include "components/player/ink/line.hpp"\n')
        self.assertIn("include each other in a circle",
                      self.rules(check_layers.check_tree(self.root)[0]))

    def test_comments_are_no_includes(self):
        self.plant("libs/core/a.cpp", '// #include "libs/robot/b.hpp"\n')
        self.assertEqual(check_layers.check_tree(self.root), ([], 1))

    def test_the_program_prints_file_line_and_rule_and_fails(self):
        self.plant("libs/core/a.cpp", '#include "libs/robot/b.hpp"\n')
        run = subprocess.run([sys.executable, "-B", HERE / "check_layers.py", "--root", self.root],
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertIn('libs/core/a.cpp:1: "libs/robot/b.hpp": libs/core may include', run.stdout)

    def test_an_empty_tree_is_a_failure(self):
        self.assertEqual(source_tree.report("check", [], 0), 1)


class CheckSpdx(TreeTest):
    def test_finds_files_without_the_two_lines(self):
        head = "\n".join(f"# {line}" for line in check_spdx.LINES) + "\n"
        self.plant("good.py", head)
        self.plant("script.sh", "#!/bin/sh\n" + head)
        self.plant("good.xml", '<?xml version="1.0"?>\n' + head.replace("# ", "<!-- ")
                   .replace("\n", " -->\n"))
        self.plant("libs/a.hpp", "#pragma once\n" + head)
        self.plant("b.yaml", head.replace("Apache-2.0", "MIT"))
        violations, checked = check_spdx.check_tree(self.root)
        self.assertEqual([violation.file for violation in violations], ["b.yaml", "libs/a.hpp"])
        self.assertEqual(checked, 5)


class CheckIncludes(TreeTest):
    def violations(self, source):
        """Of a source beside two headers, of which the second includes the first."""
        self.plant("libs/a.hpp", "namespace palpate::a {\nstruct Case {\n  int b;\n};\n"
                   "double Mean(const Case& of);\n}\n")
        self.plant("libs/b.hpp", '#include "libs/a.hpp"\nnamespace palpate::b {\n'
                   "using Kind = int;\n}\n")
        self.plant("libs/c.cpp", source)
        return self.rules(check_includes.check_tree(self.root)[0])

    def test_finds_what_a_source_forgets(self):
        for line, name in (("a::Case of;", "Case"), ("const double m = Mean(c);", "Mean"),
                           ("palpate::b::Kind k;", "Kind"), ("std::vector<Case> of;", "Case")):
            found = self.violations('R"(\n)";\nnamespace palpate {\n' + line + "\n}\n")
            self.assertIn(f"libs/c.cpp:4: {name}: include libs/", found, line)
        self.assertIn("Kind: include libs/b.hpp",
                      self.violations('#include "libs/a.hpp"\nCase c;\nKind k;\n'))

    def test_passes_what_is_reached_and_what_others_have(self):
        self.assertEqual(self.violations('#include "libs/b.hpp"\na::Case of;\nKind k;\n'), "")
        for line in ("x.Mean(c);", "x->Mean(c);", "Eigen::Case of;", "Other::Mean(c);",
                     "double Mean(int of) {\n}\ndouble m = Mean(1);", "struct Case;\nCase* of;",
                     "// Case", 'say("Case");', "#include <Case>", "TEST(Case, Mean) {"):
            self.assertEqual(self.violations(line + "\n"), "", line)


class CheckDecompositions(TreeTest):
    def broken(self, path, text):
        file = self.plant(path, f"// LLT\n{text}\n")
        violations, _ = check_decompositions.check_tree(self.root)
        file.unlink()
        return self.rules(violations)

    def test_finds_those_of_variable_size(self):
        for text in ("const Eigen::LLT<Eigen::MatrixXd> factor(A);", "Eigen::LDLT factor(A);",
                     "Eigen::SelfAdjointEigenSolver<fem::QpMatrix> eigen(A);",
                     "Eigen::JacobiSVD<Eigen::Matrix<double, 3, Eigen::Dynamic>> svd(A);",
                     "const auto x = A.ldlt().solve(b);", "x = A->partialPivLu().solve(b);",
                     "double Ln(const Eigen::MatrixXd& A) { return std::log(A.determinant()); }",
                     "x = Eigen::MatrixXd(A * B).inverse();"):
            for path in ("libs/fem/a.cpp", "components/view/a.hpp", "tests/libs/fem/a.cpp"):
                self.assertIn(f"{path}:2: ", self.broken(path, text), text)
            self.assertNotIn("libs/linalg", self.broken("libs/linalg/a.cpp", text))

    def test_passes_those_of_fixed_size(self):
        for text in ("const Eigen::LLT<Eigen::Matrix3d> factor(A);",
                     "x = Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(A).solve(b);",
                     "Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> svd(A);",
                     "const Eigen::LDLT<Matrix6d> factor(A);", "Eigen::SimplicialLDLT<Sparse> s;",
                     "const Eigen::Isometry3d T_a_b = T_b_a.inverse();", "const Lu lu(A);"):
            self.assertEqual(self.broken("libs/fem/a.cpp", text), "", text)


class CheckSizes(TreeTest):
    def found(self):
        return self.rules(check_sizes.check_tree(self.root)[0])

    def test_files_of_600_lines_and_no_more(self):
        self.plant("a.cpp", "int a;\n" * 600)
        self.assertEqual(self.found(), "")
        self.plant("a.cpp", "int a;\n" * 601)
        self.assertIn("a.cpp: 601 lines", self.found())

    def test_functions_of_60_lines_and_no_more(self):
        self.plant("a.cpp", "int F(int a) const {\n" + "  a;\n" * 58 + "}\n")
        self.assertEqual(self.found(), "")
        self.plant("a.cpp", "int b;\nint F(int a) const {\n" + "  a;\n" * 59 + "}\n")
        self.assertIn("a.cpp:2: function of 61 lines", self.found())

    def test_functions_whose_signature_takes_several_lines(self):
        head = "int F(int a,\n      int (*b)(int),\n      int c) {\n"
        block = "  if (a &&\n      (b || c)) {\n    d();\n  }\n"
        self.plant("a.cpp", head + block + "  a;\n" * 52 + "}\n")
        self.assertEqual(self.found(), "")
        self.plant("a.cpp", "int b;\n" + head + block + "  a;\n" * 53 + "}\n")
        self.assertIn("a.cpp:2: function of 61 lines", self.found())

    def test_initialisers_are_no_function(self):
        self.plant("a.cpp", "A::A()\n    : b_(1) {\n  c();\n}\n" + "int d;\n" * 60
                   + "int F() {\n  if (a) {\n    e();\n    }\n}\n")
        self.assertEqual(self.found(), "")

    def test_constructors_end_left_of_their_last_initialiser(self):
        head = "A::A()\n    : b_(1),\n      c_(F()) {\n"
        self.plant("a.cpp", head + "  d();\n}\n" + "int e;\n" * 60 + "  g([] {\n      }\n")
        self.assertEqual(self.found(), "")
        self.plant("a.cpp", head + "  d();\n" * 59 + "}\n")
        self.assertIn("a.cpp:3: function of 61 lines", self.found())

    def test_columns_and_white_space(self):
        self.plant("a.py", "a = 1\n" + "#" * 101 + "\n")
        self.assertIn("a.py:2: 101 columns", self.found())
        self.plant("a.py", "a = 1 \n")
        self.assertIn("a.py:1: trailing white space", self.found())

    def test_big_files_and_long_readmes(self):
        self.plant("a.png", "x" * 1_000_000)
        self.plant("components/view/README.md", "x\n" * 81)
        self.assertIn("a.png: 1000000 bytes", self.found())
        self.assertIn("README.md: 81 lines", self.found())
        self.plant("components/view/README.md",
                   "x\n" * 70 + "| parameter |\n|---|\n" + "| `a` |\n" * 20 + "x\n" * 8)
        self.assertNotIn("README.md", self.found())


class CheckProse(TreeTest):
    def found(self, text):
        self.plant("docs/page.md", text)
        return self.rules(check_prose.check_tree(self.root)[0])

    def test_sentences_of_25_words_and_no_more(self):
        self.assertEqual(self.found("# Page\n\n" + "w " * 24 + "end. Another one.\n"), "")
        self.assertIn("docs/page.md:3: a sentence of 26 words",
                      self.found("# Page\n\n" + "w " * 12 + "\n" + "w " * 13 + "end.\n"))

    def test_tables_headings_and_code_do_not_count(self):
        many = "told a " * 15
        self.assertEqual(self.found(f"# {many}\n\n| {many} |\n\n```sh\n{many}\n```\n"), "")

    def test_long_lines_and_replaced_words(self):
        self.assertIn("docs/page.md:1: 121 columns", self.found("x" * 121 + "\n"))
        self.assertIn('docs/page.md:1: "told"', self.found("The robot is told.\n"))


class CheckLinks(TreeTest):
    def found(self, text, path="docs/page.md"):
        self.plant("docs/other.md",
                   "# Other page\n\n## It's `x_m`, **twice**\n\n## Part\n\n## Part\n")
        self.plant("docs/image.png", "")
        self.plant(path, text)
        return self.rules(check_links.check_tree(self.root)[0])

    def test_links_and_anchors_that_exist(self):
        self.assertEqual(self.found(
            "# Page\n\n[up](#page), [other](other.md#its-x_m-twice),\n"
            "[two\nlines](other.md#part-1),\n"
            "[folder](../docs), ![image](image.png), [web](https://example.org/none.md)\n"), "")

    def test_links_to_nothing(self):
        self.assertIn("docs/page.md:3: none.md: there is no such file",
                      self.found("\n\n[a](none.md)\n"))
        self.assertIn("docs/page.md:2: other.md#none: there is no such heading",
                      self.found("[a\nb](other.md#none)\n"))
        self.assertIn("#none: there is no such heading", self.found("[a](#none)\n"))

    def test_code_holds_no_links(self):
        self.assertEqual(self.found("`[a](none.md)`\n\n```\n[a](none.md)\n```\n"), "")
        self.assertIn("no such heading", self.found("[a](#none)\n\n```\n# none\n```\n"))

    def test_pages_that_comments_name(self):
        self.assertEqual(self.found("// docs/other.md\n", "libs/a.hpp"), "")
        self.assertIn("libs/a.hpp:1: docs/none.md: there is no such file",
                      self.found("// docs/none.md\n", "libs/a.hpp"))


class CheckYaml(TreeTest):
    def test_finds_what_cannot_be_read(self):
        self.plant("good.yaml", "a: 1\nb: {a: 2}\n")
        self.plant("bad.yaml", "a: 1\nb: [1\n")
        self.plant("twice.yaml", "a: 1\nb: 2\na: 3\n")
        self.plant("bad.json", '{"a": 1,\n}')
        found = self.rules(check_yaml.check_tree(self.root)[0])
        self.assertIn("bad.yaml:", found)
        self.assertIn("twice.yaml:3: key 'a' is given twice", found)
        self.assertIn("bad.json:2:", found)
        self.assertNotIn("good.yaml", found)


class CheckFormat(TreeTest):
    def test_finds_what_is_not_formatted(self):
        program, reason = check_format.find_clang_format()
        if not program:
            self.skipTest(reason)
        self.plant(".clang-format", (HERE.parents[1] / ".clang-format").read_text())
        self.plant("good.cpp", "int* F(int a) { return nullptr; }\n")
        self.plant("bad.cpp", "int a;\nint *F( int a )\n{ return nullptr; }\n")
        violations, checked = check_format.check_tree(self.root, program)
        self.assertEqual([violation.file for violation in violations], ["bad.cpp"])
        self.assertEqual((violations[0].line, checked), (2, 2))


TOPICS = """topics:
  - {name: /forces, type: palpate_msgs/msg/ForceArray, reliability: reliable,
     durability: volatile, depth: 100, rate_hz: 30}
  - {name: /robot/mesh, type: palpate_msgs/msg/Mesh, reliability: reliable,
     durability: transient_local, depth: 1}
"""
PARAMETERS = """| parameter | default | range | meaning |
|---|---|---|---|
| `a_m` | `1` | > 0 | A |
"""
README = """# view
## Purpose
## Inputs
| topic | type | frame and units | QoS | rate |
|---|---|---|---|---|
| `/forces` | palpate_msgs/ForceArray | robot, N | reliable, volatile, keep 100 | 30 Hz |
## Outputs
| topic | type | frame and units | QoS | rate |
|---|---|---|---|---|
| `/robot/mesh` | `palpate_msgs/msg/Mesh` | robot, m | reliable, transient-local, 1 | once |
## Parameters
""" + PARAMETERS + "## Limits\n## Run\n## Test\n"


class CheckReadmes(TreeTest):
    def setUp(self):
        super().setUp()
        self.plant("config/topics.yaml", TOPICS)
        self.plant("components/view/node/main.cpp", "")
        program = self.plant("bin/palpate-view", f"#!/bin/sh\ncat <<'END'\n{PARAMETERS}END\n")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)

    def found(self, readme, fix=False):
        self.plant("components/view/README.md", readme)
        return self.rules(check_readmes.check_tree(self.root, self.root / "bin", fix)[0])

    def test_a_true_readme_passes(self):
        self.assertEqual(self.found(README), "")

    def test_a_missing_readme_and_missing_headings_are_found(self):
        found = self.rules(check_readmes.check_tree(self.root, None)[0])
        self.assertIn("components/view/README.md: is missing", found)
        self.assertIn("headings must be Purpose", self.found(README.replace("## Limits\n", "")))

    def test_untrue_topics_are_found_with_their_line(self):
        self.assertIn("README.md:6: topic /force is not in", self.found(
            README.replace("`/forces`", "`/force`")))
        self.assertIn("type of /forces must be palpate_msgs/msg/ForceArray", self.found(
            README.replace("palpate_msgs/ForceArray", "palpate_msgs/Force")))
        self.assertIn("QoS of /robot/mesh must say transient_local", self.found(
            README.replace("transient-local", "volatile")))
        self.assertIn("QoS of /forces must say reliable", self.found(
            README.replace("reliable, volatile, keep", "volatile, keep")))
        self.assertIn("must say depth 100", self.found(README.replace("keep 100", "keep 10")))

    def test_an_untrue_parameter_table_is_found_and_mended(self):
        stale = README.replace("`1` | > 0", "`2` | > 0")
        self.assertIn("README.md:14: differs from --print-config", self.found(stale))
        self.assertEqual(self.found(stale, fix=True), "")
        self.assertEqual((self.root / "components/view/README.md").read_text(), README)
        self.assertIn("parameter table is missing", self.found(README.replace(PARAMETERS, "")))


SCHEMA = """{
  "type": "object",
  "properties": {"mesh": {"type": "object", "properties": {"unit": {"enum": ["mm"]}},
                          "additionalProperties": false}},
  "additionalProperties": false
}
"""


class CheckReferences(TreeTest):
    BEGIN = "<!-- generated by: palpate reference robot -->"

    def setUp(self):
        super().setUp()
        script = (f"#!/bin/sh\ncase \"$*\" in *json-schema*) cat <<'END'\n{SCHEMA}END\n;;\n"
                  "*) echo 'keys of' $2;; esac\n")
        program = self.plant("bin/palpate", script)
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        for kind in check_references.KINDS:
            self.plant(f"docs/schema/{kind}.schema.json", SCHEMA)
        for name in check_references.DOCUMENTS:
            self.plant(name, f"# Title\n{self.BEGIN}\n\nkeys of robot\n\n"
                             f"{check_references.END}\nend\n")

    def found(self, fix=False):
        programs = self.root / "bin"
        return self.rules(check_references.check_schemas(self.root, programs, fix) +
                          check_references.check_documents(self.root, programs, fix))

    def test_generated_texts_that_are_true_pass(self):
        self.assertEqual(self.found(), "")

    def test_stale_texts_are_found_and_fixed(self):
        document = self.root / "docs/robot_file.md"
        true_text = document.read_text()
        document.write_text(true_text.replace("keys of robot", "older keys\n\nof robot"))
        (self.root / "docs/schema/robot.schema.json").write_text("{}\n")
        self.assertIn("docs/robot_file.md:4: differs from", self.found())
        self.assertIn("robot.schema.json:1: differs from", self.found())
        self.assertEqual(self.found(fix=True), "")
        self.assertEqual(document.read_text(), true_text)

    def test_a_document_without_a_generated_part_is_found(self):
        self.plant("docs/experiment.md", "# Title\n")
        self.assertIn("docs/experiment.md: has no generated part", self.found())

    def test_a_file_must_fit_its_schema_which_refuses_unknown_keys(self):
        try:
            import jsonschema
        except ModuleNotFoundError:
            self.skipTest("python3-jsonschema is not installed")
        strict = jsonschema.Draft202012Validator(json.loads(SCHEMA))
        lenient = jsonschema.Draft202012Validator({"type": "object"})
        check = check_references.check_file
        self.assertEqual(self.rules(check("a.yaml", "mesh: {unit: mm}", strict)), "")
        self.assertIn("$.mesh.unit", self.rules(check("a.yaml", "mesh: {unit: inch}", strict)))
        self.assertIn("takes an unknown key", self.rules(check("a.yaml", "mesh: {}", lenient)))


if __name__ == "__main__":
    unittest.main()
