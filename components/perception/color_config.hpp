// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/config_reader.hpp"

namespace palpate::perception {

/// Segmentation as the paper has it (section V.A, 1 and 2).
struct ColorConfig {
  double robot_color_tolerance = 0.15;
  double surface_distance_m = 0.01;
  double near_robot_m = 0.12;
  double side_m = 1.0;
  double voxel_m = 0.0;
  double outlier_radius_voxels = 3.0;
  int outlier_neighbours = 5;
  double region_distance_voxels = 3.0;
  double point_color_threshold = 12.0;
  double region_color_threshold = 10.0;
  int min_region_points = 15;
  double background_extent_m = 0.2;
  double background_thickness_m = 0.008;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("robot_color_tolerance", robot_color_tolerance, {.min = 0.0, .max = 2.0, .min_open = true},
      "A region of the robot differs so little from that colour; colours as directions, so that "
      "shading does not count");
    v("surface_distance_m", surface_distance_m, {.min = 0.0, .min_open = true},
      "Points so near to the predicted surface lie on it");
    v("near_robot_m", near_robot_m, {.min = 0.0, .max = 2.0, .min_open = true},
      "What is farther from the robot is no object");
    v("side_m", side_m, {.min = 0.0, .min_open = true},
      "PassThrough in x and y: what is farther from the optical axis is left out");
    v("voxel_m", voxel_m, {.min = 0.0, .max = 0.1},
      "VoxelGrid: edge; 0: twice the distance between pixels; more where max_cloud_points asks "
      "for it");
    v("outlier_radius_voxels", outlier_radius_voxels, {.min = 1.0, .max = 100.0},
      "RadiusOutlierRemoval: radius, in voxels");
    v("outlier_neighbours", outlier_neighbours, {.min = 0.0, .max = 1000.0},
      "RadiusOutlierRemoval: points with fewer neighbours are left out");
    v("region_distance_voxels", region_distance_voxels, {.min = 1.0, .max = 100.0},
      "Region growing: points farther apart are no neighbours");
    v("point_color_threshold", point_color_threshold, {.min = 0.0, .max = 442.0},
      "Region growing: neighbours of one region differ by less, of 255 in each channel");
    v("region_color_threshold", region_color_threshold, {.min = 0.0, .max = 442.0},
      "Region growing: regions whose means differ by less are one");
    v("min_region_points", min_region_points, {.min = 1.0, .max = 10000.0},
      "Region growing: smaller regions join a neighbour, or are left out");
    v("background_extent_m", background_extent_m, {.min = 0.0, .min_open = true},
      "Flat things at least so long are table or wall");
    v("background_thickness_m", background_thickness_m, {.min = 0.0, .min_open = true},
      "Points so near to the plane of a table or wall belong to it");
  }
};

}  // namespace palpate::perception
