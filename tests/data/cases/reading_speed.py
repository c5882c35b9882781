#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""How long large files take to read, beside VTK's reader in the same run: medians of five.

A mesh of 1 million tetrahedra as VTK itself writes it, in four storages, and a C3D file of ten
minutes with six markers at 100 Hz. VTK (python3-vtk9) reads the meshes in C++, in turns with ours.
Each reading is the first of a process, as in a program; the ratio is the median of the pairs'.

usage: reading_speed.py READ_TIMER
"""

import math
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

EDGE = 55  # bricks along each edge, six tetrahedra each: 998 250
TIMES = 5
STORAGES = ("appended raw", "appended raw, zlib", "inline base64, lz4", "ascii")
THEIRS = """
import sys, time, vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
begin = time.perf_counter()
reader.Update()
print(reader.GetOutput().GetNumberOfCells(), time.perf_counter() - begin)
"""


def make_grid(vtk):
    image = vtk.vtkImageData()
    image.SetDimensions(EDGE + 1, EDGE + 1, EDGE + 1)
    image.SetSpacing(1e-3, 1e-3, 1e-3)
    paths = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    n = EDGE + 1
    for k in range(n):
        for j in range(n):
            for i in range(n):
                points.InsertNextPoint(1e-3 * i, 1e-3 * j, 1e-3 * k)
    cells = vtk.vtkCellArray()
    for k in range(EDGE):
        for j in range(EDGE):
            for i in range(EDGE):
                corner = [(i + (c & 1)) + n * ((j + (c >> 1 & 1)) + n * (k + (c >> 2 & 1)))
                          for c in range(8)]
                for path in paths:
                    cells.InsertNextCell(4)
                    for c in path:
                        cells.InsertCellPoint(corner[c])
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.SetCells(vtk.VTK_TETRA, cells)
    return grid


def write(vtk, grid, storage, file):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    if storage.startswith("appended"):
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
    elif storage == "ascii":
        writer.SetDataModeToAscii()
    else:
        writer.SetDataModeToBinary()
    if storage.endswith("zlib"):
        writer.SetCompressorTypeToZLib()
    elif storage.endswith("lz4"):
        writer.SetCompressorTypeToLZ4()
    else:
        writer.SetCompressorTypeToNone()
    writer.Write()


def seconds_of(command, file, items):
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    count, seconds = out.split()
    if int(count) != items:
        raise SystemExit(f"{file}: {count} items instead of {items}")
    return float(seconds)


def ours_s(timer, file, items):
    return seconds_of([timer, file, "1"], file, items)


def theirs_s(file, items):
    return seconds_of([sys.executable, "-c", THEIRS, file], file, items)


def write_c3d(file):
    """Ten minutes of six markers at 100 Hz, real numbers, Intel."""
    frames, markers = 60000, 6

    def parameter(name, kind, dimensions, data, last=False):
        value = struct.pack("b", kind) + bytes([len(dimensions), *dimensions]) + data + b"\0"
        link = 0 if last else len(value) + 2
        return bytes([len(name), 1]) + name.encode() + struct.pack("<H", link) + value

    section = bytes([1, 80, 1, 84, 5, 255]) + b"POINT\3\0\0"
    section += parameter("USED", 2, [], struct.pack("<h", markers))
    section += parameter("SCALE", 4, [], struct.pack("<f", -1.0))
    section += parameter("RATE", 4, [], struct.pack("<f", 100.0))
    section += parameter("DATA_START", 2, [], struct.pack("<h", 3))
    section += parameter("FRAMES", 2, [], struct.pack("<H", frames))
    section += parameter("UNITS", -1, [2], b"mm")
    section += parameter("LABELS", -1, [2, markers], b"".join(b"m%d" % m for m in range(markers)),
                         last=True)
    header = struct.pack("<BB4HHfHHf", 2, 80, markers, 0, 1, frames, 10, -1.0, 3, 0, 100.0)
    data = b"".join(struct.pack("<4f", 100.0 * m + math.sin(0.01 * i), 20.0, 300.0, 0.0)
                    for i in range(frames) for m in range(markers))
    file.write_bytes(header.ljust(512, b"\0") + section.ljust(512, b"\0") + data)
    return frames


def main():
    timer = sys.argv[1]
    try:
        import vtk  # pylint: disable=import-outside-toplevel
    except ImportError:
        raise SystemExit("python3-vtk9 is not installed") from None
    items = 6 * EDGE ** 3
    print(f"VTK {vtk.VTK_VERSION}; medians of {TIMES}")
    print("file".ljust(44) + "size".rjust(9) + "palpate".rjust(10) + "VTK".rjust(10) +
          "ratio".rjust(8))
    with tempfile.TemporaryDirectory() as folder:
        grid = make_grid(vtk)
        for storage in STORAGES:
            file = pathlib.Path(folder) / "mesh.vtu"
            write(vtk, grid, storage, file)
            pairs = [(ours_s(timer, file, items), theirs_s(file, items)) for _ in range(TIMES)]
            ours, theirs = (statistics.median(column) for column in zip(*pairs))
            ratio = statistics.median(our / their for our, their in pairs)
            print(f".vtu, {items} tetrahedra, {storage}".ljust(44) +
                  f"{file.stat().st_size / 1e6:6.1f} MB{ours:8.2f} s{theirs:8.2f} s{ratio:8.2f}",
                  flush=True)
        file = pathlib.Path(folder) / "capture.c3d"
        frames = write_c3d(file)
        ours = statistics.median(ours_s(timer, file, frames) for _ in range(TIMES))
        print(f".c3d, {frames} frames of 6 markers".ljust(44) +
              f"{file.stat().st_size / 1e6:6.1f} MB{ours:8.2f} s")


if __name__ == "__main__":
    main()
