#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""A finger of 20 x 20 x 120 mm with a closed hollow of 10 x 10 x 100 mm, clamped at z = 0: its mesh
and robot file for palpate, and its equilibria by CalculiX on a finer mesh of other elements."""

import pathlib
import subprocess

WIDTH_M, HEIGHT_M, WALL_M, FLOOR_M = 0.020, 0.120, 0.005, 0.010
MODULUS_PA, POISSONS_RATIO, DENSITY_KG_M3, GRAVITY_M_S2 = 180e3, 0.45, 1070.0, 9.81
PUSH_N, PUSH_AT_M = 0.100, (0.0, 0.010, 0.080)  # in -y, on a patch of 10 x 10 mm
WEIGHT_N, WEIGHT_AT_M = 0.060, (0.010, 0.0, 0.110)  # in -x, the same
MARKERS_M = {f"m{k}_{side}": at
             for k, z in enumerate((0.030, 0.060, 0.090, 0.120))
             for side, at in (("x", (0.010, 0.0, z)), ("y", (0.0, -0.010, z)))}
# Corners of C3D20, then the middles of its edges, in half bricks from the lowest corner.
CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
         (0, 4), (1, 5), (2, 6), (3, 7))
# Kuhn's six tetrahedra of a brick, which fit from brick to brick.
TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))


def bricks(across, along):
    """Indices of the bricks of a grid of across x across x along that are not in the hollow."""
    for i in range(across):
        for j in range(across):
            for k in range(along):
                middle = [WIDTH_M * ((index + 0.5) / across - 0.5) for index in (i, j)]
                z = HEIGHT_M * (k + 0.5) / along
                hollow = (max(map(abs, middle)) < WIDTH_M / 2 - WALL_M
                          and FLOOR_M < z < HEIGHT_M - FLOOR_M)
                if not hollow:
                    yield i, j, k


def place(index, across, along):
    """Of a node, given in half bricks."""
    return (WIDTH_M * (index[0] / (2 * across) - 0.5), WIDTH_M * (index[1] / (2 * across) - 0.5),
            HEIGHT_M * index[2] / (2 * along))


def nodes_of(brick, local):
    return [tuple(2 * brick[a] + corner[a] for a in range(3)) for corner in local]


def write_robot(folder):
    """finger.msh (Gmsh 2.2, mm, 1824 tetrahedra) and finger.yaml, as a user writes it."""
    across, along = 4, 24
    number, cells = {}, []
    for brick in bricks(across, along):
        corners = nodes_of(brick, CORNERS)
        for index in corners:
            number.setdefault(index, len(number) + 1)
        cells += [[number[corners[c]] for c in cell] for cell in TETRAHEDRA]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(number))]
    lines += [f"{n} " + " ".join(f"{1e3 * v:.9g}" for v in place(index, across, along))
              for index, n in number.items()]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{n} 4 2 1 1 " + " ".join(map(str, cell)) for n, cell in enumerate(cells, 1)]
    (folder / "finger.msh").write_text("\n".join(lines + ["$EndElements", ""]))
    markers = "\n".join(f"  - {{name: {name}, position_m: {list(at)}}}"
                        for name, at in MARKERS_M.items())
    (folder / "finger.yaml").write_text(f"""name: finger
mesh: {{file: finger.msh, unit: mm}}
material: {{model: stable_neo_hookean, youngs_modulus_Pa: 200e3, poissons_ratio: 0.45}}
mass: {{density_kg_m3: {DENSITY_KG_M3}}}
fixed:
  - {{box_m: [[-0.011, -0.011, -0.001], [0.011, 0.011, 0.001]]}}
markers:
{markers}
""")


def traction(faces, number, force_N):
    """Consistent nodal forces on 8-node faces: -1/12 on corners, 1/3 on middles."""
    forces = {}
    for corners in faces:
        middles = [tuple((p + q) // 2 for p, q in zip(corners[k], corners[(k + 1) % 4]))
                   for k in range(4)]
        for share, nodes in ((-1 / 12, corners), (1 / 3, middles)):
            for node in nodes:
                forces[number[node]] = (forces.get(number[node], 0.0)
                                        + share * force_N / len(faces))
    return forces


def patch(cells, across, along, axis, centre_m):
    """Faces at the greatest coordinate of `axis` within 5 mm of `centre_m` along both others."""
    faces = []
    for brick in cells:
        if brick[axis] != across - 1:
            continue
        u, v = (a for a in range(3) if a != axis)
        corners = []
        for du, dv in ((0, 0), (2, 0), (2, 2), (0, 2)):
            node = [2 * index for index in brick]
            node[axis] += 2
            node[u] += du
            node[v] += dv
            corners.append(tuple(node))
        middle = [sum(place(c, across, along)[a] for c in corners) / 4 for a in range(3)]
        if all(abs(middle[a] - centre_m[a]) < 0.005 for a in (u, v)):
            faces.append(corners)
    return faces


def write_deck(file):
    """Three steps from one to the next: gravity; the push; the weight in its place. Returns the
    nodes of the markers."""
    across, along = 8, 48
    cells = list(bricks(across, along))
    number = {}
    for brick in cells:
        corners = nodes_of(brick, CORNERS)
        middles = [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in EDGES]
        for index in corners + middles:
            number.setdefault(index, len(number) + 1)
    mu = MODULUS_PA / (2 * (1 + POISSONS_RATIO))
    bulk = MODULUS_PA / (3 * (1 - 2 * POISSONS_RATIO))
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{n}," + ",".join(f"{v:.12e}" for v in place(index, across, along))
              for index, n in number.items()]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=BODY")
    for n, brick in enumerate(cells, 1):
        corners = nodes_of(brick, CORNERS)
        middles = [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in EDGES]
        names = [str(number[index]) for index in corners + middles]
        lines += [f"{n}," + ",".join(names[:10]) + ",", ",".join(names[10:])]
    lines += ["*NSET, NSET=CLAMP"] + [str(n) for index, n in number.items() if index[2] == 0]
    markers = {}
    for name, at in MARKERS_M.items():
        markers[name] = number[min(number, key=lambda index: sum(
            (p - q) ** 2 for p, q in zip(place(index, across, along), at)))]
    lines += ["*NSET, NSET=MARKERS"] + [str(n) for n in markers.values()]
    lines += ["*MATERIAL, NAME=SILICONE", "*HYPERELASTIC, NEO HOOKE",
              f"{mu / 2:.9e},{2 / bulk:.9e}", "*DENSITY", str(DENSITY_KG_M3),
              "*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE", "*BOUNDARY", "CLAMP,1,3"]
    push = traction(patch(cells, across, along, 1, PUSH_AT_M), number, -PUSH_N)
    weight = traction(patch(cells, across, along, 0, WEIGHT_AT_M), number, -WEIGHT_N)
    for direction, forces in ((0, {}), (2, push), (1, weight)):
        lines += ["*STEP, NLGEOM, INC=200", "*STATIC", "0.5,1."]
        lines += ["*DLOAD", f"BODY,GRAV,{GRAVITY_M_S2},0.,0.,-1."]
        if forces:
            lines += ["*CLOAD, OP=NEW"]
            lines += [f"{n},{direction},{force:.12e}" for n, force in forces.items()]
        lines += ["*NODE PRINT, NSET=MARKERS, FREQUENCY=999", "U", "*END STEP"]
    file.write_text("\n".join(lines) + "\n")
    return markers


def equilibria(folder):
    """{"rest" | "push" | "weight": {marker: position, m}}, computed in `folder`."""
    folder = pathlib.Path(folder)
    markers = write_deck(folder / "job.inp")
    run = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True,
                         check=False)
    if "Job finished" not in run.stdout:
        raise SystemExit("ccx found no equilibrium:\n" + run.stdout[-1500:])
    blocks = []
    for line in (folder / "job.dat").read_text().splitlines():
        if "displacements" in line:
            blocks.append({})
        elif line.strip():
            fields = line.split()
            blocks[-1][int(fields[0])] = tuple(map(float, fields[1:4]))
    if len(blocks) != 3:
        raise SystemExit(f"ccx printed {len(blocks)} states, not 3")
    return {name: {marker: tuple(p + u for p, u in zip(MARKERS_M[marker], block[node]))
                   for marker, node in markers.items()}
            for name, block in zip(("rest", "push", "weight"), blocks)}
