#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""docker/compose.yaml: one service for each component, each with no more rights than it needs.

usage: compose_test.py SOURCE_FOLDER BUILD_FOLDER
"""

import pathlib
import shutil
import sys
import unittest

import yaml

from debian_root import run

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
FILE = SOURCE / "docker/compose.yaml"
# A person at a desk runs it, or it needs a server that is no container of ours.
NO_SERVICE = {"player", "motion-capture", "bench"}


class Compose(unittest.TestCase):
    def setUp(self):
        self.compose = yaml.safe_load(FILE.read_text(encoding="utf-8"))
        self.services = self.compose["services"]

    def test_every_component_is_a_service(self):
        programs = {file.name.removeprefix("palpate-")
                    for file in (BUILD / "bin").glob("palpate-*")}
        self.assertEqual(set(self.services), programs - NO_SERVICE)
        for name, service in self.services.items():
            self.assertEqual(service["command"][0], f"palpate-{name}")

    def test_the_health_check_asks_for_the_component_itself(self):
        for name, service in self.services.items():
            test = service["healthcheck"]["test"]
            self.assertEqual(test[:4], ["CMD", "palpate", "health", name])

    def test_services_have_few_rights(self):
        for name, service in self.services.items():
            self.assertTrue(service["read_only"], name)
            self.assertTrue(service["init"], name)
            self.assertEqual(service["network_mode"], "host", name)
            self.assertEqual(service["cap_drop"], ["ALL"], name)
            self.assertEqual(service["security_opt"], ["no-new-privileges:true"], name)
            self.assertFalse({"privileged", "cap_add", "user"} & set(service), name)
            self.assertEqual("devices" in service, name == "capture", name)

    def test_older_versions_of_compose_read_it(self):
        self.assertNotIn("name", self.compose)
        if shutil.which("docker-compose"):
            run("docker-compose", "-f", FILE, "--profile", "bench", "--profile", "record",
                "--profile", "calibrate", "config", "--quiet")

    def test_the_settings_of_the_bench_are_those_of_its_processes(self):
        settings = SOURCE / "docker/bench/camera.yaml"
        for program in ("palpate-perception", "palpate-force-estimation"):
            printed = yaml.safe_load(run(BUILD / "bin" / program, "--config", settings,
                                         "--print-config"))
            self.assertIn("0.343", printed["camera_pose"])

    def test_the_image_has_one_user_and_no_compiler(self):
        lines = (SOURCE / "docker/Dockerfile").read_text(encoding="utf-8")
        run_stage = lines[lines.index("AS run"):]
        self.assertIn("\nUSER 10001:10001\n", run_stage)
        self.assertNotIn("-dev", run_stage)
        self.assertIn("--no-install-recommends", run_stage)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
