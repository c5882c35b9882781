// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
//
// Pneumatic finger: a silicone bar that stands on the plate z = 0, with one round chamber off its
// middle and a stiff layer on the other side. Under pressure the side of the chamber becomes longer
// and the finger bends towards the layer (-x). Lengths in mm.
//   gmsh -3 pneumatic_finger.geo -format msh41 -o pneumatic_finger.msh
SetFactory("OpenCASCADE");

DefineConstant[
  height = {110, Name "Finger/height"},
  width = {24, Name "Finger/width, along y"},
  depth = {22, Name "Finger/depth, along x"},
  layer = {3, Name "Finger/thickness of the stiff layer, at x = -depth / 2"},
  chamber_radius = {5, Name "Chamber/radius"},
  chamber_offset = {2, Name "Chamber/distance of its axis from the middle, towards +x"},
  root = {12, Name "Chamber/height of its lower end"},
  lid = {8, Name "Chamber/distance of its upper end from the tip"},
  cell_size = {6.5, Name "Mesh/size"}
];

bar = newv;
Box(bar) = {-depth / 2 + layer, -width / 2, 0, depth - layer, width, height};
stiff = newv;
Box(stiff) = {-depth / 2, -width / 2, 0, layer, width, height};
hollow = newv;
Cylinder(hollow) = {chamber_offset, 0, root, 0, 0, height - root - lid, chamber_radius};
body() = BooleanDifference{ Volume{bar}; Delete; }{ Volume{hollow}; Delete; };
parts() = BooleanFragments{ Volume{body()}; Delete; }{ Volume{stiff}; Delete; };

middle = depth / 2 - layer / 2;
layer_volume() = Volume In BoundingBox {-depth / 2 - 0.1, -width, -1, -depth / 2 + layer + 0.1, width, height + 1};
Physical Volume("stiff_layer") = {layer_volume()};
Physical Volume("silicone") = {parts(0)};
gap = 0.1;
wall() = Surface In BoundingBox {chamber_offset - chamber_radius - gap, -chamber_radius - gap, root - gap,
                                 chamber_offset + chamber_radius + gap, chamber_radius + gap,
                                 height - lid + gap};
Physical Surface("chamber") = {wall()};

Mesh.MeshSizeMin = 3;
Mesh.MeshSizeMax = cell_size;
Mesh.MeshSizeFromCurvature = 10;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.OptimizeThreshold = 0.5;
Mesh.RandomSeed = 1;
