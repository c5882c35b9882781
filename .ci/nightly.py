#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""As many tests of the night as fit into the given minutes, building them included.

The date chooses with which test it begins, so that in time each has its turn. What the end of the
time cuts off has neither passed nor failed. Exit code 1 where a test failed or the build did."""

import argparse
import collections
import dataclasses
import datetime
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build/release"
LINES_OF_A_FAILURE = 200


@dataclasses.dataclass(frozen=True)
class Test:
    """A test as ctest would run it."""
    name: str
    command: tuple
    folder: str = "."
    environment: tuple = ()
    limit_s: float = 1500.0
    alone: bool = False
    locks: frozenset = frozenset()
    skip_code: int | None = None  # exit code of a test that lacks what it needs

    @staticmethod
    def from_ctest(entry):
        properties = {item["name"]: item["value"] for item in entry.get("properties", [])}
        return Test(name=entry["name"], command=tuple(entry["command"]),
                    folder=properties.get("WORKING_DIRECTORY", "."),
                    environment=tuple(properties.get("ENVIRONMENT", [])),
                    limit_s=properties.get("TIMEOUT", Test.limit_s),
                    alone=properties.get("RUN_SERIAL", False),
                    locks=frozenset(properties.get("RESOURCE_LOCK", [])),
                    skip_code=properties.get("SKIP_RETURN_CODE"))


def rotate(tests, date):
    """The tests, beginning with that of the date. Two days in a row begin far apart; each test is
    once the first in as many days as there are tests."""
    if not tests:
        return []
    count = len(tests)
    step = next(step for step in range(max(1, round(0.38 * count)), 2 * count)
                if math.gcd(step, count) == 1)
    first = date.toordinal() * step % count
    return tests[first:] + tests[:first]


def end(process):
    """Ends the process and all that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


class Runner:
    """Runs tests in their order, several at a time; none begins before those in front of it."""

    def __init__(self, deadline_s, jobs, say=print):
        self.deadline_s = deadline_s
        self.jobs = jobs
        self.say = say
        self.running = {}  # process -> (test, begin, file of its output)
        self.counts = collections.Counter()

    def run(self, tests):
        waiting = collections.deque(tests)
        while waiting or self.running:
            if time.monotonic() >= self.deadline_s:
                break
            while waiting and self.may_begin(waiting[0]):
                self.begin(waiting.popleft())
            self.collect()
            time.sleep(0.02)
        for process, (test, _, output) in self.running.items():
            end(process)
            output.close()
            self.say(f"cut off   {test.name}")
        self.counts["cut off"] = len(self.running)
        self.counts["not begun"] = len(waiting)
        return self.counts

    def may_begin(self, test):
        others = [other for other, _, _ in self.running.values()]
        if not others:
            return True
        if test.alone or any(other.alone or other.locks & test.locks for other in others):
            return False
        return len(others) < self.jobs

    @staticmethod
    def result_of(test, exit_code):
        if exit_code == 0:
            return "passed"
        skipped = exit_code is not None and exit_code == test.skip_code
        return "skipped" if skipped else "FAILED"

    def begin(self, test):
        output = tempfile.TemporaryFile(mode="w+", errors="replace")
        environment = os.environ | dict(item.split("=", 1) for item in test.environment)
        process = subprocess.Popen(test.command, cwd=test.folder, env=environment, stdout=output,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        self.running[process] = (test, time.monotonic(), output)

    def collect(self):
        for process, (test, begin, output) in list(self.running.items()):
            taken_s = time.monotonic() - begin
            if process.poll() is None and taken_s < test.limit_s:
                continue
            result = self.result_of(test, process.poll())
            end(process)
            del self.running[process]
            self.counts[result.lower()] += 1
            self.say(f"{result} {taken_s:6.1f} s  {test.name}")
            if result != "passed":
                output.seek(0)
                self.say("".join(output.readlines()[-LINES_OF_A_FAILURE:]))
            output.close()


def build(seconds):
    """True: the tests are there. False: there was not enough time. Throws where it fails."""
    command = [ROOT / "run", "test", "--nightly", "-L", "nightly", "--show-only"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               start_new_session=True)
    try:
        output, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        end(process)
        return False
    if process.returncode != 0:
        print(output)
        raise subprocess.CalledProcessError(process.returncode, "./run test --nightly")
    return True


def list_tests():
    listed = subprocess.run(["ctest", "--test-dir", BUILD, "-L", "nightly",
                             "--show-only=json-v1"], check=True, capture_output=True, text=True)
    return [Test.from_ctest(entry) for entry in json.loads(listed.stdout)["tests"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--date", type=datetime.date.fromisoformat, default=datetime.date.today(),
                        help="YYYY-MM-DD (default: today)")
    options = parser.parse_args()
    begin = time.monotonic()
    deadline_s = begin + 60.0 * options.minutes
    print(f"Tests of the night, in the order of {options.date}", flush=True)
    if not build(60.0 * options.minutes):
        print("Night: 0 passed, 0 failed; building them took all the time")
        return 0
    print(f"built in {time.monotonic() - begin:.0f} s", flush=True)
    runner = Runner(deadline_s, os.cpu_count() or 1, say=lambda line: print(line, flush=True))
    counts = runner.run(rotate(list_tests(), options.date))
    print(f"Night: {counts['passed']} passed, {counts['failed']} failed, {counts['cut off']} cut "
          f"off, {counts['not begun']} not begun")
    return 1 if counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
