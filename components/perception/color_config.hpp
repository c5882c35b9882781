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
      "Largest distance of a robot region from robot_color_rgb; colours are unit vectors, so that "
      "shading has no effect");
    v("surface_distance_m", surface_distance_m, {.min = 0.0, .min_open = true},
      "Largest distance from the predicted surface of points on it");
    v("near_robot_m", near_robot_m, {.min = 0.0, .max = 2.0, .min_open = true},
      "Largest distance of an object from the robot");
    v("side_m", side_m, {.min = 0.0, .min_open = true},
      "PassThrough in x and y: largest distance from the optical axis");
    v("voxel_m", voxel_m, {.min = 0.0, .max = 0.1},
      "VoxelGrid: edge length; 0: twice the distance between pixels, or what max_cloud_points "
      "needs");
    v("outlier_radius_voxels", outlier_radius_voxels, {.min = 1.0, .max = 100.0},
      "RadiusOutlierRemoval: radius, in voxels");
    v("outlier_neighbours", outlier_neighbours, {.min = 0.0, .max = 1000.0},
      "RadiusOutlierRemoval: smallest number of neighbours");
    v("region_distance_voxels", region_distance_voxels, {.min = 1.0, .max = 100.0},
      "Region growing: largest distance of neighbours, in voxels");
    v("point_color_threshold", point_color_threshold, {.min = 0.0, .max = 442.0},
      "Region growing: largest colour difference of neighbours, of 255 per channel");
    v("region_color_threshold", region_color_threshold, {.min = 0.0, .max = 442.0},
      "Region growing: regions merge below this difference of mean colours, of 255 per channel");
    v("min_region_points", min_region_points, {.min = 1.0, .max = 10000.0},
      "Region growing: smaller regions merge with a neighbour within both thresholds, or are "
      "dropped");
    v("background_extent_m", background_extent_m, {.min = 0.0, .min_open = true},
      "Smallest length of a plane that counts as table or wall");
    v("background_thickness_m", background_thickness_m, {.min = 0.0, .min_open = true},
      "Distance from the plane of a table or wall within which points belong to it");
  }
};

}  // namespace palpate::perception
