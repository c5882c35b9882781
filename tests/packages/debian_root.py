# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of packages and images share: skipping, running programs, and the file system of a
minimal Debian 12, made by debootstrap."""

import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77  # exit code that ctest reads as "skipped"
MIRROR = "http://deb.debian.org/debian"
SECURITY = "http://deb.debian.org/debian-security"
# What the images debian:*-slim leave out.
SLIM = """path-exclude /usr/share/doc/*
path-include /usr/share/doc/*/copyright
path-exclude /usr/share/man/*
path-exclude /usr/share/locale/*
path-exclude /usr/share/info/*
path-exclude /usr/share/lintian/*
"""


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def need_tools(*tools):
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        skip(f"{', '.join(missing)} not installed (apt-get install {' '.join(missing)})")


def need_root():
    if os.geteuid() != 0:
        skip("needs root, to mount and to install packages")


def run(*words, check=True, **options):
    """The command's outputs as one text; where it fails, SystemExit with them."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False, **options)
    if check and done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}\nexit code {done.returncode}\n{done.stdout}")
    return done.stdout


def make_root(folder):
    """A file system as that of debian:bookworm-slim. Skips where no mirror answers. A folder that
    debootstrap has filled before saves the download: PALPATE_DEBIAN_ROOT."""
    folder = pathlib.Path(folder)
    made_before = os.environ.get("PALPATE_DEBIAN_ROOT")
    if made_before:
        run("cp", "--archive", made_before, folder)
    else:
        bootstrap(folder)
    return slim_down(folder)


def bootstrap(folder):
    done = subprocess.run(["debootstrap", "--variant=minbase", "bookworm", str(folder), MIRROR],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        skip(f"debootstrap made no Debian 12 from {MIRROR}: {done.stdout.splitlines()[-1]}")


def slim_down(folder):
    """Leaves out what the images debian:*-slim leave out."""
    (folder / "etc/dpkg/dpkg.cfg.d/slim").write_text(SLIM, encoding="utf-8")
    for name in ("man", "locale", "info", "lintian"):
        shutil.rmtree(folder / "usr/share" / name, ignore_errors=True)
    for file in (folder / "usr/share/doc").rglob("*"):
        if file.is_file() and file.name != "copyright":
            file.unlink()
    for file in (folder / "var/cache/apt/archives").glob("*.deb"):
        file.unlink()
    (folder / "etc/apt/sources.list").write_text(
        f"deb {MIRROR} bookworm main\ndeb {SECURITY} bookworm-security main\n", encoding="utf-8")
    for file in (folder / "var/lib/apt/lists").iterdir():
        if file.is_file():
            file.unlink()
    return folder


def in_root(root, *words, **options):
    """Runs a command in such a file system, with processes of its own that end with it."""
    environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive",
                   "LC_ALL": "C.UTF-8", "HOME": "/root"}
    return run("unshare", "--mount", "--pid", "--fork", "--kill-child",
               f"--mount-proc={root}/proc", "chroot", root, *words, env=environment, **options)


def make_packages(build, folder):
    """The .deb files of a build, made in a folder; compressed less than those of ./run package."""
    run("cpack", "--config", pathlib.Path(build) / "CPackConfig.cmake", "-B", folder,
        "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", cwd=build)
    return {file.name.partition("_")[0]: file for file in pathlib.Path(folder).glob("*.deb")}
