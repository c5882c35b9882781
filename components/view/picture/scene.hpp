// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/view/picture/camera.hpp"
#include "components/view/picture/color.hpp"
#include "components/view/picture/image.hpp"

namespace palpate::view {

/// A triangulated surface. With `scalars` it is coloured by them (0 at one end of the colour bar,
/// Scene::color_bar.maximum at the other), else plain.
struct Surface {
  Eigen::Matrix3Xd points_m;   ///< [3 x n]
  Eigen::Matrix3Xi triangles;  ///< [3 x m] point indices
  Eigen::VectorXd scalars;     ///< n values, or none
  Color color = palette::kSilicone;
  bool show_triangle_edges = true;
};

/// A line of points through space with a thickness: a cable.
struct Tube {
  Eigen::Matrix3Xd points_m;  ///< [3 x >= 2]
  double radius_m = 0.0005;
  Color color = palette::kCable;
};

/// A force: starts at `from_m`, or ends there if `points_at` is set.
struct Arrow {
  Eigen::Vector3d from_m;
  Eigen::Vector3d vector_m;  ///< direction and drawn length
  bool points_at = false;
  Color color = palette::kEstimate;
  std::string label{};  ///< beside the free end; empty: none
};

/// Points of one kind: balls (seen) or crosses (of the model, of a fixed size in the image).
struct Points {
  enum class Shape { kBall, kCross };
  Shape shape = Shape::kBall;
  Eigen::Matrix3Xd points_m;  ///< [3 x k]
  double radius_m = 0.0025;   ///< of balls
  Color color = palette::kMarker;
  std::string name{};  ///< in the legend; empty: not in it
};

/// A flat block, drawn where the body is clamped.
struct Block {
  Eigen::Vector3d center_m;
  Eigen::Matrix3d half_axes_m;  ///< columns: half edges, at right angles to each other
  Color color = palette::kClamp;
};

struct LegendEntry {
  enum class Mark { kLine, kBall, kCross };
  Mark mark = Mark::kLine;
  Color color;
  std::string text;
};

struct ColorBar {
  std::string title;            ///< quantity and unit as shown, e.g. "displacement (mm)"
  double maximum = 0.0;         ///< scalar at the upper end, > 0; the lower end is 0
  double shown_per_unit = 1.0;  ///< 1000 shows metres in mm
};

/// All of one image. Positions in m in a frame whose z points up.
struct Scene {
  int width_px = 1280;
  int height_px = 960;
  int samples_per_px = 3;  ///< along each side of a pixel
  ViewDirection view;
  std::vector<Surface> surfaces;
  std::vector<Surface> ghosts;  ///< the undeformed body: outline and a breath of grey
  std::vector<Tube> tubes;
  std::vector<Arrow> arrows;
  std::vector<Points> points;
  std::vector<Block> blocks;
  std::optional<double> floor_z_m;  ///< height of a grid under the scene
  std::optional<ColorBar> color_bar;
  std::string title;
  std::vector<std::string> caption;  ///< lines under the title
  std::vector<LegendEntry> legend;   ///< besides the named points
};

/// Draws the scene; all of it is inside the image and no two labels overlap while there is room.
/// The same scene gives the same image, bit for bit.
/// Throws RunError for a scene without anything in it, with NaN in it, with a triangle that names
/// a point that is not there, or with scalars that do not match the points.
Image RenderScene(const Scene& scene);

/// RenderScene and WritePng. Throws RunError as they do.
void SaveScene(const std::filesystem::path& path, const Scene& scene);

}  // namespace palpate::view
