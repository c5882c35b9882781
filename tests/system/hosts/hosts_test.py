#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The virtual system split over two or three hosts: network namespaces on one bridge.

usage: hosts_test.py SOURCE_FOLDER PROGRAM_FOLDER CASE   (the keys of CASES)

Ends with 77, and the reason, where namespaces or losses cannot be made.
"""

import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
LONGEST_START_S = 90.0
CUT_S = 10.0
RESUMED_WITHIN_S = 2.0
# Depth and colour take 61 MB/s, clouds at most 12 MB/s.
MOST_B_PER_S = 20e6


class Skip(Exception):
    """What the test needs is not there."""


def call(*words):
    """Output of a command that must succeed."""
    result = subprocess.run(words, check=False, capture_output=True, text=True)
    if result.returncode != 0:
        raise Skip(f"{' '.join(words)}: {result.stderr.strip() or result.returncode}")
    return result.stdout


class Network:
    """Hosts on one bridge, each a network namespace with one interface `eth0`."""

    def __init__(self, names):
        self.tag = f"pal{os.getpid() % 100000}"
        self.names = names
        self.undo = contextlib.ExitStack()
        if os.geteuid() != 0:
            raise Skip("network namespaces need root")
        try:
            self._make()
        except (Skip, FileNotFoundError) as reason:
            self.undo.close()
            raise Skip(f"no network namespaces: {reason}") from reason

    def _make(self):
        bridge = f"{self.tag}b"
        call("ip", "link", "add", bridge, "type", "bridge")
        self.undo.callback(subprocess.run, ["ip", "link", "del", bridge], check=False)
        call("ip", "link", "set", bridge, "up")
        for number, name in enumerate(self.names):
            space = self.space(name)
            call("ip", "netns", "add", space)
            self.undo.callback(subprocess.run, ["ip", "netns", "del", space], check=False)
            call("ip", "link", "add", self.outside(name), "type", "veth", "peer", "name", "eth0",
                 "netns", space)
            call("ip", "link", "set", self.outside(name), "master", bridge, "up")
            call("ip", "-n", space, "addr", "add", f"{self.address(number)}/24", "dev", "eth0")
            call("ip", "-n", space, "link", "set", "eth0", "up")
            call("ip", "-n", space, "link", "set", "lo", "up")

    def space(self, name):
        return f"{self.tag}{name}"

    def outside(self, name):
        return f"{self.tag}{name[0]}"

    @staticmethod
    def address(number):
        return f"10.213.77.{number + 1}"

    def lose(self, percent):
        """Drops that share of the packets that come to each host."""
        for name in self.names:
            space = self.space(name)
            try:
                call("ip", "netns", "exec", space, "nft", "add", "table", "ip", "loss")
                call("ip", "netns", "exec", space, "nft", "add", "chain", "ip", "loss", "in",
                     "{ type filter hook input priority 0 ; }")
                call("ip", "netns", "exec", space, "nft", "add", "rule", "ip", "loss", "in",
                     "iifname", "eth0", "numgen", "random", "mod", "1000", "<",
                     str(10 * percent), "drop")
            except Skip as nft:
                self.undo.close()
                raise Skip(f"losses need nftables: {nft}") from nft

    def cut(self, name, is_cut):
        bridge = [] if is_cut else [f"{self.tag}b"]
        call("ip", "link", "set", self.outside(name), "nomaster" if is_cut else "master", *bridge)

    def sent_by(self, name):
        """Bytes that a host has sent."""
        return int(call("ip", "netns", "exec", self.space(name), "cat",
                        "/sys/class/net/eth0/statistics/tx_bytes"))


class System:
    """The processes, and what `palpate watch` says about them on the model host."""

    def __init__(self, network, source, programs, folder, settings):
        self.network, self.programs, self.folder = network, programs, folder
        self.settings = settings
        self.processes = []
        peers = ",".join(network.address(number) for number in range(len(network.names)))
        self.environment = os.environ | {
            "CYCLONEDDS_URI": f"file://{source}/config/cyclonedds/{settings}.xml",
            "PALPATE_INTERFACE": "eth0", "PALPATE_PEERS": peers, "ROS_DOMAIN_ID": "88"}
        self.scenario = source / "config/scenarios/sensing.yaml"

    def command(self, host, program, *words):
        environment = self.environment | {"PALPATE_HOST": host}
        return (["ip", "netns", "exec", self.network.space(host), self.programs / program, *words],
                {"env": environment, "cwd": self.folder})

    def start(self, host, program, *words):
        line, options = self.command(host, program, *words)
        name = f"{host}-{program}"
        with open(self.folder / f"{name}.log", "wb") as log:
            process = subprocess.Popen(line, stdout=log, stderr=log, **options)
        self.processes.append((name, process))

    def run(self, host, program, *words):
        line, options = self.command(host, program, *words)
        return subprocess.run(line, check=True, capture_output=True, text=True, **options).stdout

    def camera_pose(self):
        """Of the scenario, as the experiment of a moment at rest tells it."""
        text = self.scenario.read_text(encoding="utf-8").partition("recordings:")[0]
        text = text.replace("four_leg_coarse.msh", f"{self.scenario.parent}/four_leg_coarse.msh")
        moment = self.folder / "moment.yaml"
        moment.write_text(text + "recordings:\n  - {name: a, kind: rest, duration_s: 0.1}\n",
                          encoding="utf-8")
        self.run("camera", "palpate", "simulate", "four_leg", "--scenario", moment,
                 "--seed", "1", "--tell-camera-pose", "--out", "exp")
        experiment = (self.folder / "exp/experiment.yaml").read_text(encoding="utf-8")
        return re.search(r"^T_robot_camera: (.*)$", experiment, re.MULTILINE)[1]

    def start_all(self):
        pose = self.camera_pose()
        raw = "dds.remote_raw=false"
        self.start("camera", "palpate-virtual-robot", "four_leg", "--scenario", self.scenario)
        self.start("camera", "palpate-virtual-camera", "four_leg", "--scenario", self.scenario)
        self.start("camera", "palpate-capture", "--camera", "127.0.0.1", "--set", raw)
        self.start("camera", "palpate-perception", "--camera-pose", pose, "--set", raw)
        self.start("model", "palpate-force-estimation", "four_leg", "--camera-pose", pose)

    def states(self, limit_s):
        """One state of the system after the other, ten a second."""
        line, options = self.command("model", "palpate", "watch", "--json", "--rate", "10")
        watch = subprocess.Popen(line, stdout=subprocess.PIPE, text=True, **options)
        begin = time.monotonic()
        try:
            for text in watch.stdout:
                if time.monotonic() - begin > limit_s:
                    return
                yield json.loads(text)
        finally:
            watch.kill()  # it may wait for room in the pipe
            watch.wait()

    def wait_for(self, condition, what, limit_s=LONGEST_START_S):
        """The first state for which `condition` holds."""
        state = None
        for state in self.states(limit_s):
            if condition(state):
                return state
        raise AssertionError(f"{what} did not come in {limit_s} s; the last state: "
                             f"{json.dumps(state)[:2000]}")

    def stop(self):
        for _, process in self.processes:
            process.send_signal(signal.SIGINT)
        for name, process in self.processes:
            process.wait(timeout=LONGEST_START_S)
            print(f"--- {name}: exit code {process.returncode}")
            print((self.folder / f"{name}.log").read_text(encoding="utf-8")[-1500:])


class LaunchedSystem(System):
    """The same, but `palpate launch` starts the processes of each host, from one system file."""

    def system_file(self, pose):
        virtual = ["four_leg", "--scenario", str(self.scenario)]
        text = {"name": "hosts", "domain": 88, "transport": self.settings, "hosts": [
            {"name": "camera", "address": self.network.address(0), "processes": [
                {"name": "virtual_robot", "component": "virtual_robot", "arguments": virtual},
                {"name": "virtual_camera", "component": "virtual_camera", "arguments": virtual},
                {"name": "capture", "component": "capture", "after": ["virtual_camera"],
                 "arguments": ["--camera", "127.0.0.1"], "required": True},
                {"name": "perception", "component": "perception", "required": True,
                 "arguments": ["--camera-pose", pose]}]},
            {"name": "model", "address": self.network.address(1), "processes": [
                {"name": "forces", "component": "force_estimation", "required": True,
                 "arguments": ["four_leg", "--camera-pose", pose]}]}]}
        return text

    def prepare(self):
        """Once each host has its file."""

    def start_all(self):
        text = json.dumps(self.system_file(self.camera_pose()))  # which is YAML, too
        for name in self.network.names:
            (self.folder / name).mkdir()
            (self.folder / name / "system.yaml").write_text(text, encoding="utf-8")
        self.prepare()
        for name in self.network.names:
            self.start(name, "palpate", "launch", f"{name}/system.yaml", "--host", name)


class SecuredSystem(LaunchedSystem):
    """The same in a secured domain."""

    def system_file(self, pose):
        return super().system_file(pose) | {"security": "keystore"}

    def prepare(self):
        """Each host gets its own identities, as docs/security.md says, and the model's `watch`."""
        system = self.folder / "model" / "system.yaml"
        told = self.run("model", "palpate", "security", "init", "keystore", "--system", system)
        for name in self.network.names:
            listed = re.search(rf"host {name}: keystore/enclaves/(.*)$", told, re.MULTILINE)[1]
            identities = listed.strip("{}").split(",") + (["observer"] if name == "model" else [])
            for identity in identities:
                enclave = f"keystore/enclaves/{identity}"
                shutil.copytree(self.folder / enclave, self.folder / name / enclave)
            self.run(name, "palpate", "security", "check", f"{name}/keystore")
        self.environment["PALPATE_SECURITY_DIR"] = str(self.folder / "model/keystore")


def forces_flow(state):
    """Frames are answered, be they ever so few: the rate is for benchmarks."""
    forces = state["forces"]
    return forces is not None and forces["silence_s"] < 1.0 and forces["status"] != "stale"


def check_steady(system):
    """Forces for ten seconds, clocks measured, and raw images stay on the camera's host."""
    system.wait_for(lambda state: forces_flow(state) and state["clocks"], "forces and clocks")
    sent, begin = system.network.sent_by("camera"), time.monotonic()
    states = list(system.states(10.0))
    last = states[-1]
    rate = (system.network.sent_by("camera") - sent) / (time.monotonic() - begin)
    forces = last["forces"]
    print(f"sent by the camera host: {1e-6 * rate:.1f} MB/s; "
          f"forces: {forces['received']} received, {forces['lost']} lost; clocks: {last['clocks']}")
    assert rate < MOST_B_PER_S, rate
    assert any(forces_flow(state) for state in states[len(states) // 2:]), forces
    clock = last["clocks"][0]
    # One kernel, one clock.
    assert abs(clock["offset_s"]) <= clock["bound_s"] + 1e-4, clock


def check_cut(system):
    """The link is cut for ten seconds; forces come again within two."""
    system.wait_for(forces_flow, "forces")
    system.network.cut("camera", True)
    time.sleep(CUT_S)
    states = system.states(LONGEST_START_S)
    next(states)
    system.network.cut("camera", False)
    begin = time.monotonic()
    first = next(states)["perception"]
    for state in states:
        perception = state["perception"]
        if perception and (not first or perception["received"] > first["received"]):
            break
    seen = time.monotonic() - begin
    for state in states:
        if forces_flow(state) and state["forces"]["status"] != "stale":
            break
    resumed = time.monotonic() - begin
    print(f"clouds {seen:.1f} s, forces {resumed:.1f} s after the link is back")
    assert resumed < RESUMED_WITHIN_S, resumed


def check_recorder(system):
    """A third host records everything but the raw images, which do not cross the link."""
    system.start("recorder", "palpate-recorder", "--out", "run.mcap", "--set",
                 "dds.remote_raw=false")
    check_steady(system)
    recorder = system.processes.pop()[1]
    recorder.terminate()
    assert recorder.wait(timeout=30) == 0
    contents = system.run("recorder", "palpate", "info", "run.mcap")
    assert re.search(r"/forces\b", contents), contents
    assert not re.search(r"image_raw \| .*Count: [1-9]", contents), contents


def check_launched(system):
    """As check_steady(); then every process ends cleanly, though a reader was killed."""
    check_steady(system)
    for _, process in system.processes:
        process.send_signal(signal.SIGINT)
    for name, process in system.processes:
        assert process.wait(timeout=LONGEST_START_S) == 0, name
        table = (system.folder / f"{name}.log").read_text(encoding="utf-8")
        assert re.search(r"stopped +0 ", table) and not re.search(r"stopped +signal", table), name


def check_secured(system):
    """As check_launched(); who has no identity sees no topic."""
    system.wait_for(forces_flow, "forces")
    line, options = system.command("model", "palpate", "topic", "list", "--domain", "88")
    plain = options | {"env": {key: value for key, value in options["env"].items()
                               if key != "PALPATE_SECURITY_DIR"}}
    topics = [subprocess.run(line, check=True, capture_output=True, text=True, **each).stdout
              for each in (options, plain)]
    assert "/forces\n" in topics[0] and "/forces\n" not in topics[1], topics
    check_launched(system)


# Hosts, settings of Cyclone DDS, lost packets in percent, how processes are started, check.
CASES = {"two_hosts": (["camera", "model"], "lan", 0, System, check_steady),
         "launch": (["camera", "model"], "lan", 0, LaunchedSystem, check_launched),
         "launch_secured": (["camera", "model"], "lan", 0, SecuredSystem, check_secured),
         "three_hosts": (["camera", "model", "recorder"], "lan", 0, System, check_recorder),
         "loss_1": (["camera", "model"], "lossy_link", 1, System, check_steady),
         "loss_5": (["camera", "model"], "lossy_link", 5, System, check_steady),
         "cut": (["camera", "model"], "lossy_link", 0, System, check_cut)}


def main():
    source, programs = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    names, settings, loss_percent, kind, check = CASES[sys.argv[3]]
    try:
        network = Network(names)
        if loss_percent:
            network.lose(loss_percent)
    except Skip as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    with network.undo, tempfile.TemporaryDirectory() as folder:
        system = kind(network, source, programs, pathlib.Path(folder), settings)
        try:
            system.start_all()
            check(system)
        finally:
            system.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
