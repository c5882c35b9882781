// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

namespace palpate::perception {

/// Class of a pixel.
enum class Label : std::uint8_t {
  kNothing,     ///< no depth, or out of range
  kBackground,  ///< on a background plane, or far from the robot
  kRobot,
  kObject,
  kMixed,      ///< at a depth edge, neither the nearer nor the farther surface
  kAmbiguous,  ///< robot or object, with too little evidence
  kSpeck,      ///< in a patch that is too small
};

/// A part of the depth image, row by row.
struct PixelRegion {
  int u_begin = 0;
  int v_begin = 0;
  int width = 0;
  int height = 0;
  std::vector<float> z_m;           ///< 0: no measurement
  std::vector<float> step_m;        ///< largest step of z to a neighbour on the same surface
  std::vector<float> distance_m;    ///< from the predicted surface; positive: before it
  std::vector<float> evidence;      ///< log of odds; positive: robot
  std::vector<char> on_background;  ///< on a plane behind the robot
  std::vector<Label> label;

  void Place(int u, int v, int width_px, int height_px);
  std::size_t size() const { return z_m.size(); }
  std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// Means of the evidence over neighbours on the same surface, 5 x 5 pixels in all; and how many of
/// the eight next pixels are on the same surface.
class EvidenceFilter {
 public:
  void Smooth(PixelRegion* region);
  int Support(std::size_t pixel) const { return static_cast<int>(support_[pixel]); }

 private:
  void AverageRing(const PixelRegion& region, int distance_px, const std::vector<float>& from,
                   std::vector<float>* to);

  std::vector<float> support_;
  std::vector<float> between_;
  std::vector<float> count_;
};

/// Patches of one label without a depth edge in them.
class Patches {
 public:
  void Find(const PixelRegion& region);
  /// Patches of `of` with fewer pixels than `least` become specks. Returns the number of their
  /// pixels.
  std::int64_t DropSmall(Label of, std::int64_t least, PixelRegion* region);
  std::int64_t Largest(Label of) const;

 private:
  struct Run {
    int row = 0;
    int begin = 0;
    int end = 0;
    Label label = Label::kNothing;
    int parent = 0;
    std::int64_t pixels = 0;  ///< of the patch, where this is its root
  };

  int RootOf(int run);
  void CutIntoRuns(const PixelRegion& region, int row);
  void Join(const PixelRegion& region, int first_above, int first_here);
  bool Touch(const PixelRegion& region, const Run& above, const Run& here) const;

  std::vector<Run> runs_;
};

}  // namespace palpate::perception
