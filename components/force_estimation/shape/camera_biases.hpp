// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "components/force_estimation/shape/bias_frame_check.hpp"
#include "components/force_estimation/shape/depth_bias.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/core/index.hpp"
#include "libs/correspondence/feature_match.hpp"

namespace palpate::force_estimation {

/// The depth bias of each camera. Cameras err independently of each other, in pose, depth and in
/// the offsets of surface points, so that nothing is shared among them. A camera without a known
/// bias beside one that has it is not used.
class CameraBiases {
 public:
  CameraBiases(int feature_count, const ShapeConfig& config)
      : feature_count_(feature_count), config_(config) {}

  /// To be called with the number of a frame's cameras before it is used.
  void HaveCameras(std::size_t count);

  /// As DepthBias::StartFrom, of one camera.
  void StartFrom(int camera, const geometry::DepthBiasMap& map,
                 const Eigen::Isometry3d& T_robot_camera);
  /// Matches of one contact-free frame, of all its cameras, as DepthBias::Learn takes those of one.
  void Learn(const std::vector<correspondence::FeatureMatch>& matches, const Eigen::VectorXd& x_m,
             const CameraPoses& poses, std::uint32_t sequence);
  /// As DepthBias::Finish. kNoCalibration where that is so of all cameras.
  Status Finish();
  /// Whether the frames of each sequence were contact-free: as the camera sees it that finds most
  /// in it.
  std::vector<BiasSequence> Judge() const;

  int frames() const;  ///< learnt, of the camera that has most
  bool known() const;  ///< of a camera at least
  bool IsKnown(std::size_t camera) const;

  /// As those of DepthBias, of the camera that sees the match.
  double Correction_m(const correspondence::FeatureMatch& match, const CameraPoses& poses) const;
  double CorrectionSigma_m(const correspondence::FeatureMatch& match,
                           const CameraPoses& poses) const;
  double NoiseScale(int camera) const { return cameras_[At(camera)].bias.NoiseScale(); }
  /// The parameters that the points of a camera share, of one camera after the other.
  Eigen::VectorXd Shared() const;
  void SetShared(const Eigen::VectorXd& shared);
  Eigen::VectorXd ScaledBasis(const correspondence::FeatureMatch& match,
                              const CameraPoses& poses) const;

 private:
  struct Camera {
    DepthBias bias;
    BiasFrameCheck check;
  };

  const DepthBias& BiasOf(const correspondence::FeatureMatch& match) const {
    return cameras_[At(match.camera)].bias;
  }

  int feature_count_;
  ShapeConfig config_;
  std::vector<Camera> cameras_;
};

}  // namespace palpate::force_estimation
