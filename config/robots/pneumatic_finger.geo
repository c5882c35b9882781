// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
//
// Pneumatic finger: a silicone bar that stands on the plate z = 0, with one round chamber off its
// middle, stiff rings around it, and a stiff layer on the other side. Under pressure the rings keep
// it thin, the side of the chamber becomes longer, and it bends towards the layer (-x). Lengths in mm.
//   gmsh -3 pneumatic_finger.geo -format msh41 -o pneumatic_finger.msh
SetFactory("OpenCASCADE");

DefineConstant[
  height = {110, Name "Finger/height"},
  width = {18, Name "Finger/width, along y"},
  depth = {18, Name "Finger/depth, along x"},
  layer = {2.5, Name "Finger/thickness of the stiff layer, at x = -depth / 2"},
  chamber_radius = {5, Name "Chamber/radius"},
  chamber_offset = {1.5, Name "Chamber/distance of its axis from the middle, towards +x"},
  root = {12, Name "Chamber/height of its lower end"},
  lid = {8, Name "Chamber/distance of its upper end from the tip"},
  ring_count = {8, Name "Rings/count"},
  ring_height = {3, Name "Rings/height"},
  facets = {12, Name "Mesh/flat facets around the chamber, those of the sizes below"},
  cell_size = {7, Name "Mesh/size"}
];

// The facets lie inside of the cylinder. So much wider it has the volume of a round chamber.
drawn_radius = chamber_radius * Sqrt(2 * Pi / facets / Sin(2 * Pi / facets));

bar = newv;
Box(bar) = {-depth / 2 + layer, -width / 2, 0, depth - layer, width, height};
stiff = newv;
Box(stiff) = {-depth / 2, -width / 2, 0, layer, width, height};
hollow = newv;
Cylinder(hollow) = {chamber_offset, 0, root, 0, 0, height - root - lid, drawn_radius};
rings() = {};
pitch = (height - root - lid) / ring_count;
For k In {0:ring_count - 1}
  ring = newv;
  Box(ring) = {-depth / 2 + layer, -width / 2, root + (k + 0.5) * pitch - ring_height / 2,
               depth - layer, width, ring_height};
  rings() += {ring};
EndFor
silicone() = BooleanDifference{ Volume{bar}; Delete; }{ Volume{hollow, rings()}; };
solid_rings() = BooleanDifference{ Volume{rings()}; Delete; }{ Volume{hollow}; Delete; };
parts() = BooleanFragments{ Volume{silicone(), solid_rings(), stiff}; Delete; }{};

Physical Volume("stiff_layer") = Volume In BoundingBox {-depth / 2 - 0.1, -width, -1, -depth / 2 + layer + 0.1, width, height + 1};
found() = {};
For k In {0:ring_count - 1}
  z = root + (k + 0.5) * pitch;
  found() += Volume In BoundingBox {-depth, -width, z - ring_height / 2 - 0.1, depth, width, z + ring_height / 2 + 0.1};
EndFor
Physical Volume("rings") = {found()};
rest() = Volume{:};
rest() -= {found()};
rest() -= Volume In BoundingBox {-depth / 2 - 0.1, -width, -1, -depth / 2 + layer + 0.1, width, height + 1};
Physical Volume("silicone") = {rest()};

gap = 0.1;
wall() = Surface In BoundingBox {chamber_offset - drawn_radius - gap, -drawn_radius - gap, root - gap,
                                 chamber_offset + drawn_radius + gap, drawn_radius + gap,
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
