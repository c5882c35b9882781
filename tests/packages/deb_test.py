#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The Debian packages: what they hold; and in a fresh Debian 12 they are installed, run the
demonstration, and go without a trace.

usage: deb_test.py BUILD_FOLDER [Packages.TEST]
"""

import pathlib
import shutil
import sys
import tempfile
import unittest

from debian_root import in_root, make_packages, make_root, need_root, need_tools, run

BUILD = pathlib.Path(sys.argv[1])
MOST_INSTALLED_MB = 250
# What dpkg, apt and ldconfig keep for themselves, and change with any package.
OF_THE_SYSTEM = ("/var/cache/", "/var/log/", "/var/lib/apt/", "/var/lib/dpkg/", "/etc/ld.so.cache",
                 "/tmp/", "/proc/", "/dev/", "/sys/", "/root/", "/run/", "/var/lib/systemd/")


def files_of(root):
    names = {f"/{file.relative_to(root)}" for file in root.rglob("*")}
    return {name for name in names if not name.startswith(OF_THE_SYSTEM)}


def size_MB(root):
    return int(run("du", "--summarize", "--bytes", root).split()[0]) / 1e6


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.packages = make_packages(BUILD, cls.folder / "packages")

    def names_of(self, package):
        return {line.split()[-1].removeprefix(".") for line in
                run("dpkg-deb", "--contents", self.packages[package]).splitlines()}

    def test_the_names_have_version_and_architecture(self):
        version = run("dpkg-deb", "--field", self.packages["palpate"], "Version").strip()
        architecture = run("dpkg", "--print-architecture").strip()
        self.assertEqual({file.name for file in self.packages.values()},
                         {f"{name}_{version}_{architecture}.deb"
                          for name in ("palpate", "palpate-engine-dev", "palpate-dev")})

    def test_programs_come_with_manuals_completions_and_units(self):
        names = self.names_of("palpate")
        programs = {name.rpartition("/")[2] for name in names if name.startswith("/usr/bin/p")}
        self.assertIn("palpate-force-estimation", programs)
        self.assertNotIn("palpate-bench", programs)
        for program in programs:
            self.assertIn(f"/usr/share/man/man1/{program}.1.gz", names)
            self.assertIn(f"/usr/share/bash-completion/completions/{program}", names)
        for name in ("/usr/lib/systemd/system/palpate@.service", "/etc/palpate/palpate.env",
                     "/usr/share/palpate/config/robots/four_leg.yaml",
                     "/usr/share/palpate/config/topics.yaml"):
            self.assertIn(name, names)
        self.assertFalse([name for name in names if name.endswith((".a", ".hpp"))])

    def test_the_engine_has_a_package_without_dds_and_settings(self):
        names = self.names_of("palpate-engine-dev")
        for name in ("/usr/lib/libpalpate_fem.a", "/usr/lib/cmake/palpate/palpate-config.cmake",
                     "/usr/include/palpate/libs/fem/elastic_body.hpp"):
            self.assertIn(name, names)
        depends = run("dpkg-deb", "--field", self.packages["palpate-engine-dev"], "Depends")
        self.assertNotIn("cyclonedds", depends)
        self.assertNotIn("yaml", depends)
        files = {name for name in names if not name.endswith("/")}
        self.assertFalse({name for name in files & self.names_of("palpate-dev")})

    def test_all_other_libraries_and_headers_are_in_another(self):
        names = self.names_of("palpate-dev")
        for name in ("/usr/lib/libpalpate_dds.a", "/usr/include/palpate/libs/app/yaml.hpp",
                     "/usr/include/palpate/palpate_msgs/msg/ForceArray.h",
                     "/usr/share/palpate/idl/palpate_msgs/package.xml"):
            self.assertIn(name, names)
        self.assertFalse([name for name in names if "/node/" in name or "/bin/" in name])

    def test_lintian_finds_no_error(self):
        if shutil.which("lintian") is None:
            self.skipTest("lintian is not installed")
        # The project has no mail address.
        said = run("lintian", "--allow-root", "--fail-on", "error", "--suppress-tags",
                   "bogus-mail-host,bogus-mail-host-in-debian-changelog",
                   *self.packages.values())
        print(said)

    def test_it_is_installed_runs_and_goes(self):
        need_root()
        need_tools("debootstrap", "unshare", "chroot")
        root = make_root(self.folder / "root")
        in_root(root, "apt-get", "update", "-qq")
        before = files_of(root)
        shutil.copy(self.packages["palpate"], root / "tmp/palpate.deb")
        in_root(root, "apt-get", "install", "--yes", "--no-install-recommends",
                "libopenblas0-pthread", "/tmp/palpate.deb")
        (root / "tmp/palpate.deb").unlink()
        in_root(root, "apt-get", "clean")
        libraries = in_root(root, "dpkg-query", "--show", "--showformat=${Package}\n").split()
        self.assertFalse([name for name in libraries if "vtk" in name or name.startswith("gcc-")
                          and name != "gcc-12-base"])
        shutil.rmtree(root / "var/lib/apt/lists")
        size = size_MB(root)
        print(f"Debian with palpate: {size:.0f} MB")
        self.assertLessEqual(size, MOST_INSTALLED_MB)

        self.assertIn("four_leg", in_root(root, "palpate", "info", "four_leg"))
        # Three times the scenario: the exit code is 0 where steady forces were found, also on a
        # machine that computes few frames a second.
        said = in_root(root, "palpate", "demo", "--out", "/tmp/demo", "--seconds", "90")
        print(said)
        self.assertTrue((root / "tmp/demo/forces.svg").is_file())

        recording = root / "var/lib/palpate/run.mcap"
        recording.parent.mkdir()
        recording.write_text("measured\n", encoding="utf-8")
        in_root(root, "apt-get", "purge", "--yes", "--auto-remove", "palpate",
                "libopenblas0-pthread")
        self.assertEqual(files_of(root) - before,
                         {"/var/lib/palpate", "/var/lib/palpate/run.mcap"})
        self.assertEqual(before - files_of(root), set())
        self.assertEqual(list((root / "var/lib/dpkg/info").glob("palpate*")), [])


if __name__ == "__main__":
    need_tools("cpack", "dpkg-deb", "dpkg-shlibdeps")
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
