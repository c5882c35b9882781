// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "components/view/picture/color.hpp"
#include "components/view/picture/image.hpp"

namespace palpate::view {

/// Where light comes from, unit vectors from the scene to the lamps and to the viewer.
struct Lighting {
  Eigen::Vector3d key;
  Eigen::Vector3d fill;
  Eigen::Vector3d toward_viewer;
};

struct Vertex {
  Eigen::Vector3d seen;    ///< x, y in px (y down; pixel (0, 0) spans [0, 1) x [0, 1)), nearness
  Eigen::Vector3d normal;  ///< in the scene, any length; zero: not shaded
  Color color;
};

/// Draws triangles and thick lines with a depth test into samples_per_px^2 samples a pixel.
/// The same calls give the same image, bit for bit, on any machine with IEEE arithmetic.
class Rasteriser {
 public:
  Rasteriser(int width_px, int height_px, int samples_per_px, const Color& background);

  /// A sample takes the triangle's colour if its centre lies in the triangle (edges included) and
  /// nothing nearer was drawn there. What lies outside the image is cut off.
  void DrawTriangle(const std::array<Vertex, 3>& vertices, const Lighting& lighting);

  /// A line with round ends; `opacity` mixes it into what is there.
  void DrawLine(const Eigen::Vector3d& from_seen, const Eigen::Vector3d& to_seen, double width_px,
                const Color& color, double opacity);

  /// Lays `veil` (same size) over this image wherever it is nearer by more than `margin`, mixed
  /// in by `opacity`.
  void Overlay(const Rasteriser& veil, double opacity, double margin = 0.0);

  /// The share of the pixel's samples on which something was drawn, in [0, 1].
  double Coverage(int x, int y) const;

  /// The nearness of what is drawn in the middle of the pixel; -infinity where nothing is.
  double NearnessAt(int x, int y) const;

  /// The image, each pixel the mean of its samples.
  Image Resolve() const;

 private:
  struct Sample {
    float nearness;
    std::array<std::uint8_t, 3> rgb;
  };

  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  int samples_per_px_;
  int columns_;  // of samples
  int rows_;
  std::vector<Sample> samples_;
};

}  // namespace palpate::view
