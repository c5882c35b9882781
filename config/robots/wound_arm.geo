// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
//
// Segment of a pneumatic arm: a silicone cylinder that stands on the plate z = 0, with three round
// chambers around its axis. The robot file winds fibres into its skin; the mesh knows nothing of
// them. mm.
//   gmsh -3 wound_arm.geo -format msh41 -o wound_arm.msh
SetFactory("OpenCASCADE");

DefineConstant[
  height = {90, Name "Arm/height"},
  radius = {20, Name "Arm/radius"},
  chamber_radius = {5, Name "Chambers/radius"},
  chamber_offset = {10, Name "Chambers/distance of their axes from the arm's"},
  root = {10, Name "Chambers/height of their lower ends"},
  lid = {10, Name "Chambers/distance of their upper ends from the tip"},
  cell_size = {7.5, Name "Mesh/size"}
];

body = newv;
Cylinder(body) = {0, 0, 0, 0, 0, height, radius};
hollows() = {};
For k In {0:2}
  hollow = newv;
  Cylinder(hollow) = {chamber_offset * Cos(k * 2 * Pi / 3), chamber_offset * Sin(k * 2 * Pi / 3),
                      root, 0, 0, height - root - lid, chamber_radius};
  hollows() += {hollow};
EndFor
silicone() = BooleanDifference{ Volume{body}; Delete; }{ Volume{hollows()}; Delete; };
Physical Volume("silicone") = {silicone()};

gap = 0.1;
For k In {0:2}
  x = chamber_offset * Cos(k * 2 * Pi / 3);
  y = chamber_offset * Sin(k * 2 * Pi / 3);
  wall() = Surface In BoundingBox {x - chamber_radius - gap, y - chamber_radius - gap, root - gap,
                                   x + chamber_radius + gap, y + chamber_radius + gap,
                                   height - lid + gap};
  Physical Surface(Sprintf("chamber_%g", k + 1)) = {wall()};
EndFor

Mesh.MeshSizeMin = 3.5;
Mesh.MeshSizeMax = cell_size;
Mesh.MeshSizeFromCurvature = 9;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.OptimizeThreshold = 0.5;
Mesh.RandomSeed = 1;
