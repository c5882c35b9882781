#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The services of systemd, in a container that boots it: all components start in their sandbox, are
well, start again after a crash, and stop.

usage: services_test.py SOURCE_FOLDER BUILD_FOLDER
"""

import json
import pathlib
import sys
import tempfile
import time

from debian_root import need_root, need_tools, skip

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "docker"))
import check  # noqa: E402

LIMIT_S = 180
# The image's own user and its folder are not those of the package.
IMAGE = """FROM localhost/palpate
USER root
RUN apt-get update -qq && apt-get install --yes -qq --no-install-recommends systemd dbus && \\
    userdel palpate && rm -r /var/lib/palpate
WORKDIR /
CMD ["/lib/systemd/systemd"]
"""
SCENARIO = "--scenario /usr/share/palpate/config/scenarios/sensing.yaml"
ARGUMENTS = {
    "virtual-robot": f"four_leg {SCENARIO} --set threads=1",
    "virtual-camera": f"four_leg {SCENARIO} --set interface_address=127.0.0.1",
    "capture": "--camera 127.0.0.1",
    "perception": "--config /etc/palpate/camera.yaml",
    "force-estimation": "four_leg --config /etc/palpate/camera.yaml",
    "calibration": "four_leg --out calibration.yaml",
    "recorder": "--robot four_leg",
}
UNITS = [f"palpate@{component}" for component in ARGUMENTS]


class Host:
    """A container with systemd, without a network."""

    def __init__(self, store, settings):
        self.store = store
        started = store.podman(
            "run", "--detach", "--timeout", "900", "--name", "host", "--systemd", "always",
            "--privileged", "--network", "none", "--runtime", "runc",
            "--ulimit", "nofile=1024:1024", "--ulimit", "nproc=4096:4096", "--volume",
            f"{settings}:/etc/palpate:ro", "services", check=False)
        until(lambda: self.call("systemctl", "is-system-running", must=False).strip()
              in ("running", "degraded"), lambda: skip(f"systemd does not boot here: {started}"))

    def call(self, *words, must=True):
        variables = [f"--env={key}={value}" for key, value in check.ENVIRONMENT.items()]
        return self.store.podman("exec", *variables, "host", *words, check=must)

    def state(self, unit, name):
        return self.call("systemctl", "show", "--value", "--property", name, unit).strip()

    def health(self):
        said = self.call("palpate", "health", *ARGUMENTS, "--any-status", "--json", must=False)
        return json.loads(said) if said.startswith("{") else {"well": False, "said": said}

    def explain(self):
        raise SystemExit(f"{self.health()}\n" + self.call(
            "systemctl", "--no-pager", "status", *UNITS, must=False))


def until(holds, otherwise):
    end = time.monotonic() + LIMIT_S
    while not holds():
        if time.monotonic() > end:
            otherwise()
        time.sleep(0.5)


def write_settings(folder):
    folder.mkdir()
    for component, arguments in ARGUMENTS.items():
        (folder / f"{component}.env").write_text(f"ARGUMENTS={arguments}\n", encoding="utf-8")
    settings = "\n".join(f"{key}={value}" for key, value in check.ENVIRONMENT.items())
    (folder / "palpate.env").write_text(settings + "\n", encoding="utf-8")
    camera = (SOURCE / "docker/bench/camera.yaml").read_text(encoding="utf-8")
    (folder / "camera.yaml").write_text(camera, encoding="utf-8")
    return folder


def run_services(host):
    host.call("systemctl", "enable", *UNITS)
    host.call("systemctl", "start", "palpate.target")
    until(lambda: host.health()["well"], host.explain)
    for unit in UNITS:
        print(f"{unit}: {host.state(unit, 'ActiveState')}")
    pid = host.state("palpate@recorder", "MainPID")
    status = host.call("cat", f"/proc/{pid}/status")
    fields = dict(line.split(":\t", 1) for line in status.splitlines() if ":\t" in line)
    rights = {name: fields[name].strip() for name in ("CapEff", "NoNewPrivs", "Seccomp")}
    print(f"recorder: {rights}")
    if rights != {"CapEff": "0" * 16, "NoNewPrivs": "1", "Seccomp": "2"}:
        raise SystemExit("a service has more rights than its unit says")

    host.call("systemctl", "kill", "--signal", "KILL", "palpate@perception")
    until(lambda: host.state("palpate@perception", "NRestarts") == "1" and host.health()["well"],
          host.explain)
    print("perception: well again after SIGKILL")

    host.call("systemctl", "stop", "palpate.target")
    results = {unit: host.state(unit, "Result") for unit in UNITS}
    print(results)
    if set(results.values()) != {"success"}:
        raise SystemExit("a service did not stop")
    if "recording_" not in host.call("ls", "/var/lib/palpate/"):
        raise SystemExit("no recording in /var/lib/palpate")


def main():
    need_root()
    need_tools("debootstrap", "buildah", "podman", "runc", "cpack")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        store = check.Store(folder)
        check.import_debian(store, folder)
        check.build_image(store, BUILD, folder, from_sources=False)
        (folder / "services").write_text(IMAGE, encoding="utf-8")
        store.buildah("bud", "--isolation", "chroot", "--pull-never", "--layers=false", "-t",
                      "services", "-f", folder / "services", folder / "context")
        try:
            run_services(Host(store, write_settings(folder / "settings")))
        finally:
            store.podman("rm", "--all", "--force", "--time", "1", check=False)
    return 0


if __name__ == "__main__":
    sys.exit(main())
