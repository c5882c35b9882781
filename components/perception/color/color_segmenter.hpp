// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "components/perception/color/voxel_cloud.hpp"
#include "components/perception/config.hpp"
#include "components/perception/registered_frame.hpp"
#include "components/perception/segmenter.hpp"
#include "libs/rgbd/surface_view.hpp"

namespace palpate::perception {

struct ColorSegmenterTuning {
  /// Share of a region's voxels on the predicted surface above which it is the robot's. Smaller:
  /// objects that touch the robot join it.
  double region_share = 0.5;
  std::size_t fewest_color_voxels = 30;  ///< that give the robot's colour; fewer: a random colour
};

/// The paper's method (section V.A): filters, then region growing by colour, which assumes that the
/// robot has one colour of its own. The reference for the model-aware method; all filters and
/// segmentations are PCL's.
class ColorSegmenter : public Segmenter {
 public:
  /// Throws InputError for an invalid robot colour.
  explicit ColorSegmenter(const Config& config, const ColorSegmenterTuning& tuning = {});

  void SetCamera(const rgbd::RgbdCamera& camera) override;
  const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                const PredictedSurface* predicted) override;

 private:
  enum class Label : char { kNothing, kRobot, kObject };

  geometry::Box Bounds(const PredictedSurface* predicted) const;
  void MarkOnSurface(const VoxelCloud& cloud, const PredictedSurface* predicted);
  void EstimateColor(const VoxelCloud& cloud);
  bool IsRobot(const VoxelCloud& cloud, const std::vector<int>& region) const;
  void LabelRobot(const VoxelCloud& cloud, const std::vector<std::vector<int>>& regions);
  void LabelObjects(const VoxelCloud& cloud, const std::vector<std::vector<int>>& regions);
  rgbd::SensedCloud Take(const VoxelCloud& cloud, Label label) const;

  Config config_;
  ColorSegmenterTuning tuning_;
  std::optional<Eigen::Vector3d> robot_color_;  ///< unit
  std::unique_ptr<Registration> registration_;
  std::unique_ptr<rgbd::SurfaceView> view_;
  RegisteredFrame registered_;
  std::vector<char> on_surface_;  ///< [voxels] on the predicted one
  std::vector<Label> labels_;     ///< [voxels]
  SegmentedFrame segmented_;
};

}  // namespace palpate::perception
