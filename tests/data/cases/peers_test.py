#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Readers of others agree with ours value by value: meshio and VTK on meshes, PCL on clouds.

Ours are asked through files that palpate writes again: `palpate solve --vtu` without load for
meshes. Each reader that is not installed skips its test with the reason.

usage: peers_test.py PROGRAM
"""

import base64
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import make_cases as cases

PROGRAM = sys.argv.pop(1)
ROBOT = """name: bar
mesh: {{file: "{file}", unit: mm}}
element: tet4
material: {{model: linear, youngs_modulus_Pa: 100.0e3, poissons_ratio: 0.3}}
mass: {{density_kg_m3: 1000}}
gravity_m_s2: [0, 0, 0]
fixed: [{{box_m: [[-1, -1, -1], [0.001, 1, 1]]}}]
"""


def module(name):
    try:
        return __import__(name)
    except ImportError:
        raise unittest.SkipTest(f"python3-{name} is not installed") from None


def near(a, b, tolerance):
    return len(a) == len(b) and all(math.isclose(x, y, rel_tol=0, abs_tol=tolerance)
                                    for p, q in zip(a, b) for x, y in zip(p, q))


def turned(cell, nodes):
    """The corners of the tetrahedron, 1 and 2 exchanged where its volume is negative."""
    origin, a, b, c = ([float(v) for v in nodes[k]] for k in cell)
    a, b, c = ([v - o for v, o in zip(corner, origin)] for corner in (a, b, c))
    volume = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
              a[2] * (b[0] * c[1] - b[1] * c[0]))
    return tuple(cell) if volume > 0 else (cell[0], cell[2], cell[1], cell[3])


def written_cells(vtu):
    """The tetrahedra of a .vtu of ours: base64, headers of UInt64, blocks of zlib."""
    text = vtu.split('Name="connectivity"', 1)[1].split(">", 1)[1].split("<", 1)[0].strip()
    blocks = struct.unpack("<Q", base64.b64decode(text[:12])[:8])[0]
    header_letters = (8 * (3 + blocks) + 2) // 3 * 4
    sizes = struct.unpack_from(f"<{blocks}Q", base64.b64decode(text[:header_letters]), 24)
    packed = base64.b64decode(text[header_letters:])
    data = b""
    for size in sizes:
        data += zlib.decompress(packed[:size])
        packed = packed[size:]
    numbers = struct.unpack(f"<{len(data) // 4}i", data)
    return [numbers[k:k + 4] for k in range(0, len(numbers), 4)]


class Peers(unittest.TestCase):

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        cases.write_all(self.folder)

    def ours(self, name):
        """Nodes in m and cells, as palpate reads the mesh."""
        robot = self.folder / "robot.yaml"
        robot.write_text(ROBOT.format(file=self.folder / name), encoding="utf-8")
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        result = subprocess.run([PROGRAM, "solve", robot, "--out", out, "--vtu"],
                                capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual(result.returncode, 0, f"{name}: {result.stderr}")
        rows = (out / "nodes_0000.csv").read_text(encoding="utf-8").splitlines()[1:]
        nodes = [tuple(map(float, row.split(",")[1:4])) for row in rows]
        return nodes, written_cells((out / "body_0000.vtu").read_text(encoding="ascii"))

    def check_mesh(self, name, theirs_mm, their_cells):
        """Nodes and the corners of every cell, in the order of the file. Cells that lie the other
        way round are turned, and of equal ones the first is kept."""
        nodes, cells = self.ours(name)
        self.assertTrue(near(nodes, [tuple(1e-3 * v for v in node) for node in theirs_mm], 1e-12),
                        name)
        first = {}
        for cell in their_cells:
            first.setdefault(frozenset(cell), turned(cell, theirs_mm))
        self.assertEqual(cells, list(first.values()), name)

    def test_meshio(self):
        meshio = module("meshio")
        # meshio 5.3 reads no LZ4, no strings in fields, no Gmsh 2.0 and no cells of type 71.
        names = ("gmsh22.msh", "gmsh41.msh", "plain.vtu", "lzma.vtu", "zlib_big_endian.vtu",
                 "abaqus.inp", "medit.mesh")
        for name in names:
            with self.subTest(name):
                mesh = meshio.read(self.folder / name)
                theirs = [cell for block in mesh.cells if block.type == "tetra"
                          for cell in block.data.tolist()]
                _, cells, left = cases.bar()
                whole = len(cells) + (sum(left) if name == "gmsh22.msh" else 0)
                self.assertEqual(len(theirs), whole)
                self.check_mesh(name, mesh.points, theirs)

    def test_vtk(self):
        vtk = module("vtk")
        for name in sorted(cases.MESHES):
            is_xml = name.endswith(".vtu") or name == "xml.vtk"
            if not is_xml and not name.endswith(".vtk"):
                continue
            with self.subTest(name):
                reader = vtk.vtkXMLUnstructuredGridReader() if is_xml else \
                    vtk.vtkUnstructuredGridReader()
                reader.SetFileName(str(self.folder / name))
                reader.Update()
                grid = reader.GetOutput()
                _, cells, left = cases.bar()
                theirs = []
                for k in range(grid.GetNumberOfCells()):
                    ids = grid.GetCell(k).GetPointIds()
                    theirs.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
                self.check_mesh(name, [grid.GetPoint(k) for k in range(grid.GetNumberOfPoints())],
                                theirs)
                part = grid.GetCellData().GetArray("part")
                values = [int(part.GetValue(k)) for k in range(len(cells))]
                self.assertEqual(values, [1 if is_left else 2 for is_left in left])

    def test_pcl(self):
        converter = shutil.which("pcl_convert_pcd_ascii_binary")
        if converter is None:
            raise unittest.SkipTest("pcl-tools is not installed")
        for name in ("ascii.pcd", "unsigned.pcd", "binary.pcd", "compressed.pcd"):
            with self.subTest(name):
                again = self.folder / "again.pcd"
                subprocess.run([converter, self.folder / name, again, "1"], check=True,
                               capture_output=True)
                bytes_ = again.read_bytes()
                head, data = bytes_.split(b"DATA binary\n", 1)
                self.assertIn(b"FIELDS x y z rgb", head)
                theirs = [struct.unpack_from("<3fI", data, 16 * k)
                          for k in range(cases.COLUMNS * cases.ROWS)]
                self.assertTrue(near([p[:3] for p in theirs], cases.points_m(), 1e-6))
                for k, point in enumerate(theirs):
                    r, g, b = cases.color(k)
                    self.assertEqual(point[3] & 0xffffff, r << 16 | g << 8 | b)
                for file in (again, self.folder / name):
                    found = json.loads(subprocess.run([PROGRAM, "info", file, "--json"], text=True,
                                                      capture_output=True, check=True).stdout)
                    self.assertEqual(found["points"], len(theirs))


if __name__ == "__main__":
    unittest.main()
