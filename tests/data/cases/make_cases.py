# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Small files of the kinds that laboratories bring, all of the same content.

Motion capture: markers tip and mid in 8 frames at 100 Hz, mid missing in frames 3 and 4.
Meshes: a bar of 40 x 20 x 10 mm, of which the half with x < 20 mm is the group 'left'.
Clouds: 12 points in 4 columns and 3 rows, 0.3 to 0.41 m before the camera, coloured.
"""

import base64
import lzma
import math
import pathlib
import struct
import zlib

FRAMES = 8
RATE_HZ = 100
GAP = (3, 4)
MARKERS = ("tip", "mid")


def position_mm(marker, frame):
    """None where the marker is not seen."""
    if marker == "mid" and frame in GAP:
        return None
    x = 100.0 * MARKERS.index(marker) + math.sin(0.3 * frame)
    return (x, 20.0, 300.0 - 0.25 * frame)


# Meshes.

BRICKS = (4, 2, 1)
BRICK_MM = 10.0
VOLUME_MM3 = 40.0 * 20.0 * 10.0
# Six tetrahedra about the diagonal of a brick, corners by their bits x, y, z.
PATHS = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))


def bar():
    """Nodes in mm, tetrahedra of rising volume, and whether each is of the left half."""
    nx, ny, nz = (n + 1 for n in BRICKS)
    nodes = [(BRICK_MM * i, BRICK_MM * j, BRICK_MM * k)
             for k in range(nz) for j in range(ny) for i in range(nx)]
    cells, left = [], []
    for k in range(BRICKS[2]):
        for j in range(BRICKS[1]):
            for i in range(BRICKS[0]):
                corner = [(i + (c & 1)) + nx * ((j + (c >> 1 & 1)) + ny * (k + (c >> 2 & 1)))
                          for c in range(8)]
                cells += [tuple(corner[c] for c in path) for path in PATHS]
                left += [i < BRICKS[0] // 2] * len(PATHS)
    return nodes, cells, left


def lines(rows):
    return "\n".join(" ".join(str(v) for v in row) for row in rows) + "\n"


def gmsh2(version, binary=False):
    """Left half in two physical groups that overlap, written once for each: all 1, left 2."""
    nodes, cells, left = bar()
    elements = [(1, cell) for cell in cells]
    elements += [(2, cell) for cell, is_left in zip(cells, left) if is_left]
    head = f"$MeshFormat\n{version} {int(binary)} 8\n"
    names = '$PhysicalNames\n2\n3 1 "all"\n3 2 "left"\n$EndPhysicalNames\n'
    if not binary:
        return (head + "$EndMeshFormat\n" + names + f"$Nodes\n{len(nodes)}\n" +
                lines((n, *x) for n, x in enumerate(nodes, 1)) +
                f"$EndNodes\n$Elements\n{len(elements)}\n" +
                lines((e, 4, 2, group, 1, *(n + 1 for n in cell))
                      for e, (group, cell) in enumerate(elements, 1)) + "$EndElements\n").encode()
    # As a machine of the other byte order writes it.
    data = (head.encode() + struct.pack(">i", 1) + b"\n$EndMeshFormat\n" + names.encode() +
            f"$Nodes\n{len(nodes)}\n".encode())
    data += b"".join(struct.pack(">i3d", n, *x) for n, x in enumerate(nodes, 1))
    data += f"\n$EndNodes\n$Elements\n{len(elements)}\n".encode()
    data += struct.pack(">3i", 4, len(elements), 2)
    data += b"".join(struct.pack(">7i", e, group, 1, *(n + 1 for n in cell))
                     for e, (group, cell) in enumerate(elements, 1))
    return data + b"\n$EndElements\n"


def gmsh4(version):
    nodes, cells, left = bar()
    parts = [[c for c, l in zip(cells, left) if l], [c for c, l in zip(cells, left) if not l]]
    box = "0 0 0 1 1 1"
    text = (f"$MeshFormat\n{version} 0 8\n$EndMeshFormat\n"
            '$PhysicalNames\n2\n3 1 "all"\n3 2 "left"\n$EndPhysicalNames\n'
            f"$Entities\n0 0 0 2\n1 {box} 2 1 2 0\n2 {box} 1 1 0\n$EndEntities\n")
    limits = f" 1 {len(nodes)}" if version == "4.1" else ""
    order = "3 1" if version == "4.1" else "1 3"
    text += f"$Nodes\n1 {len(nodes)}{limits}\n{order} 0 {len(nodes)}\n"
    if version == "4.1":
        text += lines((n,) for n in range(1, len(nodes) + 1)) + lines(nodes)
    else:
        text += lines((n, *x) for n, x in enumerate(nodes, 1))
    limits = f" 1 {len(cells)}" if version == "4.1" else ""
    text += f"$EndNodes\n$Elements\n2 {len(cells)}{limits}\n"
    number = 1
    for entity, part in enumerate(parts, 1):
        text += f"3 {entity} 4 {len(part)}\n" if version == "4.1" else f"{entity} 3 4 {len(part)}\n"
        text += lines((number + k, *(n + 1 for n in cell)) for k, cell in enumerate(part))
        number += len(part)
    return (text + "$EndElements\n").encode()


def vtk(version, binary=False, cell_type=10, turned=()):
    nodes, cells, left = bar()
    cells = [(c[0], c[2], c[1], c[3]) if k in turned else c for k, c in enumerate(cells)]
    out = (f"# vtk DataFile Version {version}\nbar\n{'BINARY' if binary else 'ASCII'}\n"
           "DATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nnote 1 2 string\n").encode()
    out += b"\x85hello\x86POINTS\n" if binary else b"hello\nPOINTS 9 in a text\n"
    if binary:
        out = out.replace(b"\x85hello\x86POINTS", b"\xc5hello\xc6POINTS")

    def numbers(form, values):
        values = list(values)
        if binary:
            return struct.pack(f">{len(values)}{form}", *values) + b"\n"
        return (" ".join(map(str, values)) + "\n").encode()

    out += f"POINTS {len(nodes)} double\n".encode() + numbers("d", (v for x in nodes for v in x))
    out += b"METADATA\nINFORMATION 0\n\n"
    if version == "5.1":
        out += (f"CELLS {len(cells) + 1} {4 * len(cells)}\nOFFSETS vtktypeint64\n".encode() +
                numbers("q", range(0, 4 * len(cells) + 1, 4)) + b"CONNECTIVITY vtktypeint64\n" +
                numbers("q", (n for c in cells for n in c)))
    else:
        out += (f"CELLS {len(cells)} {5 * len(cells)}\n".encode() +
                numbers("i", (n for c in cells for n in (4, *c))))
    out += f"CELL_TYPES {len(cells)}\n".encode() + numbers("i", [cell_type] * len(cells))
    out += (f"POINT_DATA {len(nodes)}\nVECTORS u double\n".encode() +
            numbers("d", [0.5] * 3 * len(nodes)))
    out += (f"CELL_DATA {len(cells)}\nSCALARS part int 1\nLOOKUP_TABLE default\n".encode() +
            numbers("i", (1 if is_left else 2 for is_left in left)))
    return out


def lz4_block(data):
    """A valid block of LZ4 that holds `data` as literals only."""
    length = len(data)
    token = bytes([min(length, 15) << 4])
    extra = b""
    if length >= 15:
        rest = length - 15
        extra = b"\xff" * (rest // 255) + bytes([rest % 255])
    return token + extra + data


PACKERS = {
    "": ("", None),
    "zlib": ("vtkZLibDataCompressor", zlib.compress),
    "lz4": ("vtkLZ4DataCompressor", lz4_block),
    "lzma": ("vtkLZMADataCompressor", lambda data: lzma.compress(data, format=lzma.FORMAT_XZ)),
}


def packed(data, packing, wide, order):
    """Header and data of an array, as VTK writes it in blocks of 512 bytes."""
    word = (">" if order == "BigEndian" else "<") + ("Q" if wide else "I")
    compress = PACKERS[packing][1]
    if compress is None:
        return struct.pack(word, len(data)), data
    blocks = [data[k:k + 512] for k in range(0, len(data), 512)]
    pieces = [compress(block) for block in blocks]
    header = [len(blocks), 512, len(blocks[-1]) % 512, *(len(piece) for piece in pieces)]
    return b"".join(struct.pack(word, value) for value in header), b"".join(pieces)


def vtu(packing="", storage="inline", wide=False, order="LittleEndian"):
    nodes, cells, left = bar()
    end = ">" if order == "BigEndian" else "<"
    arrays = {
        "Points": ("Float64", "d", [v for x in nodes for v in x], ' NumberOfComponents="3"'),
        "connectivity": ("Int64", "q", [n for c in cells for n in c], ""),
        "offsets": ("Int64", "q", [4 * (k + 1) for k in range(len(cells))], ""),
        "types": ("UInt8", "B", [10] * len(cells), ""),
        "part": ("Int32", "i", [1 if is_left else 2 for is_left in left], ""),
    }
    appended = b""
    texts = {}
    for name, (kind, form, values, more) in arrays.items():
        head, data = packed(struct.pack(f"{end}{len(values)}{form}", *values), packing, wide, order)
        coded = base64.b64encode(head) + base64.b64encode(data)
        attributes = f'type="{kind}" Name="{name}"{more}'
        if storage == "inline":
            texts[name] = f'<DataArray {attributes} format="binary">{coded.decode()}</DataArray>\n'
        else:
            texts[name] = f'<DataArray {attributes} format="appended" offset="{len(appended)}"/>\n'
            appended += coded if storage == "base64" else head + data
    compressor = f' compressor="{PACKERS[packing][0]}"' if packing else ""
    header = ' header_type="UInt64"' if wide else ""
    xml = (f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
           f'byte_order="{order}"{header}{compressor}>\n<UnstructuredGrid>\n'
           f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(cells)}">\n'
           f'<CellData Scalars="part">{texts["part"]}</CellData>\n'
           f'<Points>{texts["Points"]}</Points>\n'
           f'<Cells>{texts["connectivity"]}{texts["offsets"]}{texts["types"]}</Cells>\n'
           "</Piece>\n</UnstructuredGrid>\n").encode()
    if storage != "inline":
        xml += f'<AppendedData encoding="{storage}">_'.encode() + appended + b"</AppendedData>\n"
    return xml + b"</VTKFile>\n"


def abaqus(eol="\n"):
    nodes, cells, left = bar()
    rows = ["*HEADING", "bar", "*NODE, NSET=ALL"]
    rows += [f"{n}, {x:.6e}, {y:.6e}, {z:.6e}" for n, (x, y, z) in enumerate(nodes, 1)]
    rows += ["*ELEMENT, TYPE=C3D4, ELSET=all"]
    rows += [", ".join(map(str, (e, *(n + 1 for n in c)))) for e, c in enumerate(cells, 1)]
    rows += ["*ELSET, ELSET=left"]
    rows += [f"{e}," for e, is_left in enumerate(left, 1) if is_left]
    return (eol.join(rows) + eol).encode()


def abaqus_cae():
    """A part, and an assembly whose reference point has a number that a node has, too."""
    part = abaqus().decode().replace("*HEADING\nbar\n", "*HEADING\nbar\n*PART, NAME=bar\n")
    part = part.replace("TYPE=C3D4, ELSET=all", "TYPE=C3D4,\n ELSET=all")
    return (part + "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=bar-1, PART=bar\n*END INSTANCE\n"
            "*NODE\n1, 0., 0., 99.\n*ELSET, ELSET=both, INSTANCE=bar-1\nLEFT,\n"
            "*END ASSEMBLY\n").encode()


def medit():
    nodes, cells, left = bar()
    return (f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(nodes)}\n" +
            lines((*x, 0) for x in nodes) + f"Triangles\n1\n1 2 3 9\nTetrahedra\n{len(cells)}\n" +
            lines((*(n + 1 for n in c), 1 if is_left else 2) for c, is_left in zip(cells, left)) +
            "End\n").encode()


def netgen():
    """Left-handed cells, as Netgen exports them."""
    nodes, cells, _ = bar()
    return ("$MeshFormat\n2.000000 0 8\n$EndMeshFormat\n" + f"$Nodes\n{len(nodes)}\n" +
            lines((n, *x) for n, x in enumerate(nodes, 1)) +
            f"$EndNodes\n$Elements\n{len(cells)}\n" +
            lines((e, 4, 2, 1, 1, c[0] + 1, c[2] + 1, c[1] + 1, c[3] + 1)
                  for e, c in enumerate(cells, 1)) + "$EndElements\n").encode()


# Motion capture.

def vax(value):
    """A real number of a DEC VAX."""
    bits = struct.unpack("<I", struct.pack("<f", 4.0 * value))[0]
    return struct.pack("<HH", bits >> 16, bits & 0xffff)


def c3d(processor=84, real=True, gap="residual", told_by=""):
    """processor: 84 Intel, 85 DEC, 86 SGI. gap: 'residual' -1, 'nan' or 'zero'. told_by: the
    parameter that says that there are angles, without listing them: 'groups' or 'units'."""
    points = [*MARKERS, "LKneeAngles"] if told_by else [*MARKERS]
    end = ">" if processor == 86 else "<"

    def word(value):
        return struct.pack(end + "h", value)

    def number(value):
        return vax(value) if processor == 85 and value == value else struct.pack(end + "f", value)

    scale = -1.0 if real else 0.05

    def parameter(name, kind, dimensions, data, last=False):
        value = struct.pack("b", kind) + bytes([len(dimensions), *dimensions]) + data + b"\0"
        link = 0 if last else len(value) + 2
        return bytes([len(name), 1]) + name.encode() + word(link) + value

    group = bytes([5, 255]) + b"POINT" + word(3) + b"\0"
    section = bytes([1, 80, 1, processor]) + group
    section += parameter("USED", 2, [], word(len(points)))
    section += parameter("SCALE", 4, [], number(scale))
    section += parameter("RATE", 4, [], number(float(RATE_HZ)))
    section += parameter("DATA_START", 2, [], word(3))
    section += parameter("FRAMES", 2, [], word(FRAMES))
    section += parameter("UNITS", -1, [2], b"mm")
    section += parameter("TYPE_GROUPS", -1, [6, 1], b"ANGLES") if told_by == "groups" else b""
    section += parameter("ANGLE_UNITS", -1, [3], b"deg") if told_by == "units" else b""
    width = max(map(len, points))
    section += parameter("LABELS", -1, [width, len(points)],
                         "".join(label.ljust(width) for label in points).encode(), last=True)
    header = (bytes([2, 80]) + word(len(points)) + word(0) + word(1) + word(FRAMES) + word(10) +
              number(scale) + word(3) + word(0) + number(float(RATE_HZ)))
    data = b""
    for frame in range(FRAMES):
        for marker in points:
            place = position_mm(marker, frame) if marker in MARKERS else (90.0, 1.0, 2.0)
            missing = {"residual": (0.0, 0.0, 0.0), "zero": (0.0, 0.0, 0.0),
                       "nan": (math.nan,) * 3}[gap]
            fourth = -1 if place is None and gap == "residual" else 0
            values = missing if place is None else place
            if real:
                data += b"".join(map(number, values)) + number(float(fourth))
            else:
                data += b"".join(word(round(v / scale)) for v in values) + word(fourth)
    return header.ljust(512, b"\0") + section.ljust(512, b"\0") + data


def cells_of(frame, unit, missing, separator):
    row = []
    for marker in MARKERS:
        place = position_mm(marker, frame)
        row += [missing] * 3 if place is None else [f"{unit * v:.6f}" for v in place]
    return separator.join(row)


def motive():
    names = [name for name in MARKERS for _ in range(3)]
    rows = [f"Format Version,1.23,Take Name,bench,Export Frame Rate,{RATE_HZ}.000000,"
            "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global", "",
            ",Type," + ",".join(["Marker"] * 6), ",Name," + ",".join(names),
            ",ID," + ",".join(names), ",," + ",".join(["Position"] * 6),
            "Frame,Time (Seconds)," + ",".join("XYZ" * 2)]
    rows += [f"{f},{f / RATE_HZ:.6f}," + cells_of(f, 1e-3, "", ",") for f in range(FRAMES)]
    return ("\ufeff" + "\r\n".join(rows) + "\r\n").encode()


def nexus():
    rows = ["Devices", "1000", ",,Force", "Frame,Sub Frame,Fx", ",,N", "1,0,0.5", "1,1,0.5", "",
            "Trajectories", str(RATE_HZ), ",,rig:tip,,,rig:mid,,", "Frame,Sub Frame,X,Y,Z,X,Y,Z",
            ",,mm,mm,mm,mm,mm,mm"]
    rows += [f"{f + 1},0," + cells_of(f, 1.0, "", ",") for f in range(FRAMES)]
    return ("\n".join(rows) + "\n").encode()


def qualisys(comma=False):
    rows = [f"NO_OF_FRAMES\t{FRAMES}", "NO_OF_CAMERAS\t8", "NO_OF_MARKERS\t2",
            f"FREQUENCY\t{RATE_HZ}", "DESCRIPTION\t--", "TIME_STAMP\t2026-01-01, 00:00:00.000\t1.5",
            "DATA_INCLUDED\t3D", "EVENT\tpress\t4\t0.03", "MARKER_NAMES\ttip\tmid"]
    frames = [cells_of(f, 1.0, "0.000", "\t") for f in range(FRAMES)]
    rows += [frame.replace(".", ",") if comma else frame for frame in frames]
    return ("\r\n".join(rows) + "\r\n").encode()


def qualisys_bodies():
    rows = [f"NO_OF_FRAMES\t{FRAMES}", "NO_OF_BODIES\t2", f"FREQUENCY\t{RATE_HZ}",
            "DATA_INCLUDED\t6D", "BODY_NAMES\ttip\tmid"]
    for f in range(FRAMES):
        row = []
        for marker in MARKERS:
            place = position_mm(marker, f) or (0.0, 0.0, 0.0)
            row += [f"{v:.6f}" for v in place] + ["0"] * 4 + "1 0 0 0 1 0 0 0 1".split()
        rows.append("\t".join(row))
    return ("\n".join(rows) + "\n").encode()


def trc():
    rows = ["PathFileType\t4\t(X/Y/Z)\tbench.trc",
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate",
            f"{RATE_HZ}\t{RATE_HZ}\t{FRAMES}\t2\tmm\t{RATE_HZ}", "Frame#\tTime\ttip\t\t\tmid\t\t",
            "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", ""]
    rows += [f"{f + 1}\t{f / RATE_HZ:.3f}\t" + cells_of(f, 1.0, "", "\t") for f in range(FRAMES)]
    return ("\n".join(rows) + "\n").encode()


def table(separator=",", comma=False, missing="NaN", encoding="utf-8", eol="\n"):
    rows = [separator.join(("t_s", "marker", "x_mm", "y_mm", "z_mm"))]
    for f in range(FRAMES):
        for marker in MARKERS:
            place = position_mm(marker, f)
            numbers = [missing] * 3 if place is None else [f"{v:.6f}" for v in place]
            time = f"{f / RATE_HZ:.2f}"
            if comma:
                numbers, time = [n.replace(".", ",") for n in numbers], time.replace(".", ",")
            rows.append(separator.join((time, marker, *numbers)))
    return (eol.join(rows) + eol).encode(encoding)


# Clouds.

COLUMNS, ROWS = 4, 3


def points_m():
    return [(0.01 * (i - 1.5), 0.01 * (j - 1), 0.3 + 0.01 * (COLUMNS * j + i))
            for j in range(ROWS) for i in range(COLUMNS)]


def color(k):
    return (10 * k, 250 - 10 * k, 7)


def ply(form="ascii", scale=1.0, negate=False, extra=False, channel="uchar"):
    head = [f"format {form} 1.0", "comment made by hand", f"element vertex {COLUMNS * ROWS}"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += ["property float nx"] if extra else []
    head += [f"property {channel} {c}" for c in ("red", "green", "blue")]
    head += ["element face 1", "property list uchar int vertex_indices"]
    sign = -1.0 if negate else 1.0
    end = ">" if form == "binary_big_endian" else "<"
    data = b""
    for k, (x, y, z) in enumerate(points_m()):
        place = [scale * x, sign * scale * y, sign * scale * z] + ([0.5] if extra else [])
        if form == "ascii":
            shown = [c / 255.0 if channel == "float" else c for c in color(k)]
            data += (" ".join(f"{v:.6g}" for v in place + shown) + "\n").encode()
        else:
            data += struct.pack(f"{end}{len(place)}f3B", *place, *color(k))
    data += b"3 0 1 2\n" if form == "ascii" else struct.pack(end + "B3i", 3, 0, 1, 2)
    return ("ply\n" + "\n".join(head) + "\nend_header\n").encode() + data


def pcd(data="ascii", kind="F"):
    head = ("# .PCD v.7 - Point Cloud Data file format\nVERSION .7\n"
            "FIELDS x y z rgb\nSIZE 4 4 4 4\n"
            f"TYPE F F F {kind}\nCOUNT 1 1 1 1\nWIDTH {COLUMNS}\nHEIGHT {ROWS}\n"
            f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {COLUMNS * ROWS}\nDATA {data}\n").encode()
    columns = [[], [], [], []]
    text = ""
    for k, place in enumerate(points_m()):
        r, g, b = color(k)
        bits = r << 16 | g << 8 | b
        for column, value in zip(columns, place):
            column.append(struct.pack("<f", value))
        columns[3].append(struct.pack("<I", bits))
        shown = struct.unpack("<f", struct.pack("<I", bits))[0] if kind == "F" else bits
        text += " ".join(f"{v:.6g}" for v in place) + f" {shown!r}\n"
    if data == "ascii":
        return head + text.encode()
    if data == "binary":
        return head + b"".join(b"".join(point) for point in zip(*columns))
    plain = b"".join(b"".join(column) for column in columns)
    pieces = [plain[k:k + 32] for k in range(0, len(plain), 32)]
    lzf = b"".join(bytes([len(piece) - 1]) + piece for piece in pieces)
    return head + struct.pack("<II", len(lzf), len(plain)) + lzf


MESHES = {
    "gmsh20.msh": gmsh2("2"), "gmsh21.msh": gmsh2("2.1"), "gmsh22.msh": gmsh2("2.2"),
    "gmsh22_big_endian.msh": gmsh2("2.2", binary=True), "gmsh40.msh": gmsh4("4"),
    "gmsh41.msh": gmsh4("4.1"), "netgen.msh": netgen(),
    "vtk30.vtk": vtk("3.0"), "vtk42_binary.vtk": vtk("4.2", binary=True), "vtk51.vtk": vtk("5.1"),
    "vtk51_binary.vtk": vtk("5.1", binary=True), "lagrange.vtk": vtk("4.2", cell_type=71),
    "mixed.vtk": vtk("4.2", turned=(1, 5, 17)), "xml.vtk": vtu(),
    "plain.vtu": vtu(), "zlib_big_endian.vtu": vtu("zlib", order="BigEndian"),
    "lz4.vtu": vtu("lz4"), "lz4_raw.vtu": vtu("lz4", "raw", wide=True),
    "lzma.vtu": vtu("lzma"), "lzma_base64.vtu": vtu("lzma", "base64"),
    "abaqus.inp": abaqus(), "abaqus_crlf.inp": abaqus("\r\n"), "abaqus_cae.inp": abaqus_cae(),
    "medit.mesh": medit(),
}

CAPTURES = {
    "intel.c3d": c3d(), "dec.c3d": c3d(85), "sgi.c3d": c3d(86), "dec_integers.c3d": c3d(85, False),
    "sgi_integers.c3d": c3d(86, False), "nan.c3d": c3d(gap="nan"), "zeros.c3d": c3d(gap="zero"),
    "outputs_by_group.c3d": c3d(told_by="groups"), "outputs_by_unit.c3d": c3d(told_by="units"),
    "motive.csv": motive(), "nexus.csv": nexus(), "qualisys.tsv": qualisys(),
    "qualisys_commas.tsv": qualisys(comma=True),
    "qualisys_bodies.tsv": qualisys_bodies(), "cortex.trc": trc(), "table.csv": table(),
    "excel.csv": table(";", comma=True, missing="", eol="\r\n"), "tabs.tsv": table("\t"),
    "unicode.txt": table("\t", missing="#N/A", encoding="utf-16"),
}

CLOUDS = {
    "ascii.ply": ply(), "float_colors.ply": ply(channel="float"),
    "little.ply": ply("binary_little_endian"),
    "big.ply": ply("binary_big_endian"), "normals.ply": ply("binary_little_endian", extra=True),
    "viewer.ply": ply("binary_little_endian", negate=True), "millimetres.ply": ply(scale=1000.0),
    "ascii.pcd": pcd(), "unsigned.pcd": pcd(kind="U"), "binary.pcd": pcd("binary"),
    "compressed.pcd": pcd("binary_compressed", "U"),
}


def write_all(folder):
    for name, data in {**MESHES, **CAPTURES, **CLOUDS}.items():
        (pathlib.Path(folder) / name).write_bytes(data)
