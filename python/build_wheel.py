#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Packs the built Python package as a wheel (PEP 427), with the standard library alone.

usage: build_wheel.py PACKAGE_FOLDER OUTPUT_FOLDER
"""

import base64
import hashlib
import pathlib
import sys
import sysconfig
import zipfile

METADATA = """Metadata-Version: 2.1
Name: palpate
Version: {version}
Summary: Finite-element models of soft robots, and forces on them from measured markers
License: Apache-2.0
Requires-Python: ==3.11.*
Requires-Dist: numpy
"""
WHEEL = """Wheel-Version: 1.0
Generator: palpate
Root-Is-Purelib: false
Tag: {tag}
"""


def read_version(package):
    sys.path.insert(0, str(package.parent))
    import palpate

    return palpate.__version__


def digest(data):
    raw = hashlib.sha256(data).digest()
    return "sha256=" + base64.urlsafe_b64encode(raw).rstrip(b"=").decode()


def files_of(package):
    for path in sorted(package.iterdir()):
        if path.suffix in (".py", ".pyi", ".so") or path.name == "py.typed":
            yield f"palpate/{path.name}", path.read_bytes()


def main():
    package, output = (pathlib.Path(argument) for argument in sys.argv[1:3])
    version = read_version(package)
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], platform)
    info = f"palpate-{version}.dist-info"
    content = dict(files_of(package))
    content[f"{info}/METADATA"] = METADATA.format(version=version).encode()
    content[f"{info}/WHEEL"] = WHEEL.format(tag=tag).encode()
    record = "".join(f"{name},{digest(data)},{len(data)}\n" for name, data in content.items())
    content[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    output.mkdir(parents=True, exist_ok=True)
    wheel = output / f"palpate-{version}-{tag}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(name, data)
    print(wheel)
    return 0


if __name__ == "__main__":
    sys.exit(main())
