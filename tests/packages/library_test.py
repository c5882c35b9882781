#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of docs/library are built with the installed engine, and print what the pages say.

usage: library_test.py SOURCE_FOLDER BUILD_FOLDER [Library.TEST]
"""

import pathlib
import re
import sys
import tempfile
import unittest

from debian_root import run

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
OUTSIDE = r"^(dds|yaml|spdlog|CLI)|_msgs/|libs/app/|config_reader"
PROGRAM = re.compile(r"```cpp\n(.*?)```\n\n```text\n(.*?)```", re.DOTALL)
LIST = """cmake_minimum_required(VERSION 3.25)
project(pages LANGUAGES C CXX)
set(CMAKE_CXX_STANDARD 20)
find_package(palpate REQUIRED COMPONENTS fem robot)
foreach(page {pages})
  add_executable(${{page}} ${{page}}.cpp)
  target_link_libraries(${{page}} PRIVATE palpate::robot)
endforeach()
"""


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.prefix = cls.folder / "installed"
        run("cmake", "--install", BUILD, "--component", "engine", "--prefix", cls.prefix)
        pages = {page.stem: PROGRAM.findall(page.read_text(encoding="utf-8"))
                 for page in (SOURCE / "docs/library").glob("*.md") if page.stem != "index"}
        cls.pages = {name: found[0] for name, found in pages.items() if len(found) == 1}
        cls.without = set(pages) - set(cls.pages)

    def test_each_page_has_one_program_that_prints_what_it_says(self):
        self.assertEqual(self.without, set())
        self.assertGreaterEqual(len(self.pages), 5)
        for name, (program, _) in self.pages.items():
            (self.folder / f"{name}.cpp").write_text(program, encoding="utf-8")
        (self.folder / "CMakeLists.txt").write_text(LIST.format(pages=" ".join(self.pages)),
                                                    encoding="utf-8")
        run("cmake", "-S", self.folder, "-B", self.folder / "build", "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=Debug",
            "-DCMAKE_DISABLE_FIND_PACKAGE_CycloneDDS=ON")
        run("cmake", "--build", self.folder / "build")
        for name, (_, output) in self.pages.items():
            with self.subTest(name):
                self.assertEqual(run(self.folder / "build" / name,
                                     SOURCE / "config/robots/beam.msh"), output)

    def test_headers_are_complete_and_know_neither_dds_nor_settings_files(self):
        root = self.prefix / "include/palpate"
        headers = sorted(root.rglob("*.hpp"))
        self.assertGreater(len(headers), 30)
        for header in headers:
            for included in re.findall(r'^#include [<"]([^">]+)', header.read_text("utf-8"),
                                       re.MULTILINE):
                where = f"{header.relative_to(root)}: {included}"
                if included.startswith("libs/"):
                    self.assertTrue((root / included).is_file(), where)
                self.assertNotRegex(included, OUTSIDE, where)

    def test_a_component_that_is_not_there_is_refused(self):
        folder = self.folder / "refused"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(refused LANGUAGES C CXX)\n"
            "find_package(palpate COMPONENTS robots)\n"
            'file(WRITE ${CMAKE_BINARY_DIR}/found "${palpate_FOUND}")\n', encoding="utf-8")
        run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.assertEqual((folder / "build/found").read_text("utf-8").upper() in ("0", "FALSE"),
                         True)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
