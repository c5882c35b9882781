// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
//
// Four-legged silicone body: four legs, each a quarter of an elliptic arch, rise from four feet and
// carry a hub. Lengths in mm; x east, y north, z up; the feet stand on the ground plate z = 0.
//   gmsh -3 four_leg.geo -format msh41 -o four_leg.msh
SetFactory("OpenCASCADE");

DefineConstant[
  leg_outer_span = {93, Name "Leg/outer span"},
  leg_outer_height = {112, Name "Leg/outer height"},
  leg_thickness = {20, Name "Leg/thickness"},
  leg_width = {22, Name "Leg/width"},
  leg_start = {14, Name "Leg/distance of its upper end from the axis, inside the hub"},
  hub_radius = {30, Name "Hub/radius"},
  hub_half_height = {22, Name "Hub/half height"},
  hub_centre_height = {103, Name "Hub/height of its centre"},
  foot_radius = {17, Name "Foot/radius"},
  foot_height = {8, Name "Foot/height"},
  cell_size = {8.5, Name "Mesh/size"}
];

foot_distance = leg_outer_span - leg_thickness / 2;
hub = newv;
Sphere(hub) = {0, 0, 0, 1};
Dilate {{0, 0, 0}, {hub_radius, hub_radius, hub_half_height}} { Volume{hub}; }
Rotate {{0, 0, 1}, {0, 0, 0}, Pi / 4} { Volume{hub}; }  // its seam lies between two legs
Translate {0, 0, hub_centre_height} { Volume{hub}; }

legs_and_feet() = {};
For leg In {0:3}
  outer = newv;
  Cylinder(outer) = {0, -leg_width / 2, 0, 0, leg_width, 0, 1};
  Dilate {{0, 0, 0}, {leg_outer_span, 1, leg_outer_height}} { Volume{outer}; }
  inner = newv;
  Cylinder(inner) = {0, -leg_width, 0, 0, 2 * leg_width, 0, 1};
  Dilate {{0, 0, 0}, {leg_outer_span - leg_thickness, 1, leg_outer_height - leg_thickness}}
    { Volume{inner}; }
  tube() = BooleanDifference{ Volume{outer}; Delete; }{ Volume{inner}; Delete; };
  quarter = newv;
  Box(quarter) = {leg_start, -leg_width, 0, leg_outer_span, 2 * leg_width, 2 * leg_outer_height};
  arch() = BooleanIntersection{ Volume{tube()}; Delete; }{ Volume{quarter}; Delete; };
  Rotate {{0, 0, 1}, {0, 0, 0}, leg * Pi / 2} { Volume{arch()}; }
  foot = newv;
  Cylinder(foot) = {foot_distance * Cos(leg * Pi / 2), foot_distance * Sin(leg * Pi / 2), 0,
                    0, 0, foot_height, foot_radius};
  legs_and_feet() += {arch(), foot};
EndFor

body() = BooleanUnion{ Volume{hub}; Delete; }{ Volume{legs_and_feet()}; Delete; };
Physical Volume("body") = {body()};

Mesh.MeshSizeMin = cell_size;
Mesh.MeshSizeMax = cell_size;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.OptimizeThreshold = 0.5;
Mesh.RandomSeed = 1;
