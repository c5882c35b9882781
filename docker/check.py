#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the image without a daemon and without a registry, and runs the services of compose.yaml
on the virtual bench, each as compose would: read-only, without rights, not as root.

usage: check.py BUILD_FOLDER [--from-sources]

The packages come from the build, or, with --from-sources, from the builder stage of the Dockerfile.
Needs root, debootstrap, buildah, podman and runc; exit code 77 with the reason where one lacks.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/packages"))
from debian_root import make_packages, make_root, need_root, need_tools, run, skip  # noqa: E402

MOST_MB = 250
DOMAIN = "97"
START_LIMIT_S = 120
# Nothing of these is left out or added by the network of the machine.
ENVIRONMENT = {"ROS_DOMAIN_ID": DOMAIN,
               "CYCLONEDDS_URI": "file:///usr/share/palpate/config/cyclonedds/one_host.xml"}


class Store:
    """Images and containers in a folder of their own."""

    def __init__(self, folder):
        self.options = ["--root", folder / "images", "--runroot", folder / "run"]

    def buildah(self, *words):
        return run("buildah", *self.options, *words)

    def podman(self, *words, check=True):
        return run("podman", *self.options, "--cgroup-manager", "cgroupfs", *words, check=check)


def import_debian(store, folder):
    """The base images, from Debian's mirror."""
    root = make_root(folder / "debian")
    run("tar", "-C", root, "-cf", folder / "debian.tar", ".")
    shutil.rmtree(root)
    for name in ("bookworm-slim", "bookworm"):
        store.podman("import", folder / "debian.tar", f"docker.io/library/debian:{name}")


def build_image(store, build, folder, from_sources):
    words = ["bud", "--isolation", "chroot", "--pull-never", "--layers=false", "-t", "palpate",
             "-f", ROOT / "docker/Dockerfile"]
    if not from_sources:
        (folder / "context").mkdir()
        for package in make_packages(build, folder / "packages").values():
            shutil.copy(package, folder / "context")
        words += ["--build-context", f"packages={folder / 'context'}"]
    print(store.buildah(*words, ROOT).splitlines()[-1])


def check_image(store):
    size_MB = json.loads(store.podman("image", "inspect", "palpate"))[0]["Size"] / 1e6
    print(f"image: {size_MB:.0f} MB")
    if size_MB > MOST_MB:
        raise SystemExit(f"the image has {size_MB:.0f} MB, more than {MOST_MB}")
    tools = run_once(store, ["sh", "-c", "id -u; command -v cc gcc g++ clang cmake ld as; true"])
    if tools.split() != ["10001"]:
        raise SystemExit(f"not one user without compilers: {tools}")
    libraries = run_once(store, ["sh", "-c", "for p in /usr/bin/palpate*; do ldd $p; done"])
    missing = {line.strip() for line in libraries.splitlines() if "not found" in line}
    if missing:
        raise SystemExit(f"programs lack libraries: {missing}")


def container_words(name, service=None):
    """What compose gives a service, as options of podman run."""
    words = ["--timeout", "900", "--network", "host", "--runtime", "runc",
             "--ulimit", "nofile=1024:1024", "--ulimit", "nproc=1024:1024",
             "--read-only", "--tmpfs", "/tmp", "--cap-drop", "ALL",
             "--security-opt", "no-new-privileges", "--name", name,
             "--volume", f"{ROOT / 'docker/bench'}:/etc/palpate:ro"]
    for key, value in ENVIRONMENT.items():
        words += ["--env", f"{key}={value}"]
    if service and any(volume.startswith("recordings:") for volume in service["volumes"]):
        words += ["--volume", "recordings:/var/lib/palpate"]
    return words


def run_once(store, command, check=True):
    return store.podman("run", "--rm", *container_words("once"), "palpate", *command, check=check)


def command_of(service):
    """The command as compose gives it where no variable is set."""
    return [re.sub(r"\$\{\w+:-([^}]*)\}", r"\1", word) for word in service["command"]]


def is_healthy(store, name, service):
    """Asks by the health check of the service, in its container."""
    done = subprocess.run(
        ["podman", *map(str, store.options), "--cgroup-manager", "cgroupfs", "exec", name,
         *service["healthcheck"]["test"][1:]], capture_output=True, text=True, check=False)
    return done.returncode == 0


def run_services(store, services):
    for name, service in services.items():
        store.podman("run", "--detach", *container_words(name, service), "palpate",
                     *command_of(service))
    waiting, end = set(services), time.monotonic() + START_LIMIT_S
    while waiting and time.monotonic() < end:
        waiting = {name for name in waiting if not is_healthy(store, name, services[name])}
    for name in services:
        print(f"{name}: {'not healthy' if name in waiting else 'healthy'}")
    end += START_LIMIT_S
    if waiting:
        logs = "\n".join(f"{name}:\n{store.podman('logs', '--tail', '5', name, check=False)}"
                         for name in waiting)
        raise SystemExit(f"not healthy within {START_LIMIT_S} s\n{logs}")
    forces = None
    while not (forces and forces["rate_hz"]) and time.monotonic() < end:
        snapshot = run_once(store, ["palpate", "watch", "--once", "--json"])
        forces = json.loads(snapshot)["forces"]
    if not (forces and forces["rate_hz"]):
        raise SystemExit("no messages of /forces")
    print(f"forces: {forces['rate_hz']:.1f} Hz, {forces['status']} {forces['reason']}")


def stop_services(store, services):
    """SIGTERM ends each with 0."""
    codes = {}
    for name in services:
        store.podman("stop", "--time", "20", name)
        codes[name] = int(store.podman("wait", name))
        store.podman("rm", "--force", name)
    print(f"exit codes: {codes}")
    if set(codes.values()) != {0}:
        raise SystemExit("a service did not end with 0")


def main():
    need_root()
    need_tools("debootstrap", "buildah", "podman", "runc", "cpack")
    build = pathlib.Path(sys.argv[1])
    compose = (ROOT / "docker/compose.yaml").read_text(encoding="utf-8")
    services = yaml.safe_load(compose)["services"]
    services.pop("calibration")  # it works on request
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        store = Store(folder)
        import_debian(store, folder)
        build_image(store, build, folder, "--from-sources" in sys.argv)
        check_image(store)
        probe = run_once(store, ["palpate", "--version"], check=False)
        if not probe.startswith("palpate "):
            skip(f"podman starts no container here: {probe.strip().splitlines()[-1]}")
        try:
            run_services(store, services)
            stop_services(store, services)
        finally:
            store.podman("rm", "--all", "--force", check=False)
    return 0


if __name__ == "__main__":
    sys.exit(main())
