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

/// The paper's way (section V.A): filters, then region growing by colour, which takes the robot to
/// be of one colour that nothing else has. The reference that the model-aware way is compared with;
/// all filters and segmentations are PCL's.
class ColorSegmenter : public Segmenter {
 public:
  /// Throws InputError for a robot colour that is none.
  explicit ColorSegmenter(const Config& config);

  void SetCamera(const rgbd::RgbdCamera& camera) override;
  const SegmentedFrame& Segment(const rgbd::RgbdFrame& frame,
                                const PredictedSurface* predicted) override;

 private:
  enum class Label : char { kNothing, kRobot, kObject };

  geometry::Box Bounds(const PredictedSurface* predicted) const;
  void MarkOnSurface(const VoxelCloud& cloud, const PredictedSurface* predicted);
  void LearnColor(const VoxelCloud& cloud);
  bool IsRobot(const VoxelCloud& cloud, const std::vector<int>& region) const;
  void LabelRobot(const VoxelCloud& cloud, const std::vector<std::vector<int>>& regions);
  void LabelObjects(const VoxelCloud& cloud, const std::vector<std::vector<int>>& regions);
  rgbd::SensedCloud Take(const VoxelCloud& cloud, Label label) const;

  Config config_;
  std::optional<Eigen::Vector3d> robot_color_;  ///< unit
  std::unique_ptr<Registration> registration_;
  std::unique_ptr<rgbd::SurfaceView> view_;
  RegisteredFrame registered_;
  std::vector<char> on_surface_;  ///< [voxels] on the predicted one
  std::vector<Label> labels_;     ///< [voxels]
  SegmentedFrame segmented_;
};

}  // namespace palpate::perception
