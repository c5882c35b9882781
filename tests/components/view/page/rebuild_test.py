#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The committed page is what its sources make: `npm ci && npm run build` gives the same bytes.
Skips with the reason where Node, npm or the network is missing."""

import argparse
import pathlib
import shutil
import sys
import tempfile

import run

WEB = run.HERE.parents[3] / "components/view/web"


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    run.need(("node", "nodejs"), ("npm", "npm"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "web"
        shutil.copytree(WEB, folder, ignore=shutil.ignore_patterns("node_modules", "dist"))
        run.npm(["ci"], folder)
        run.npm(["run", "build"], folder)
        made, committed = contents(folder / "dist"), contents(WEB / "dist")
    different = sorted(name for name in made.keys() | committed.keys()
                       if made.get(name) != committed.get(name))
    if different:
        sys.exit(f"components/view/web/dist differs from its sources: {', '.join(different)}; "
                 "run `npm ci && npm run build` in components/view/web and commit dist")
    print(f"{len(made)} files, the same bytes")


if __name__ == "__main__":
    main()
