// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/pipeline/shape_pipeline.hpp"
#include "components/offline/forces/replay_perception.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// The nearest number to the time of a frame, s.
inline double FrameTime_s(std::int64_t t_ns) { return static_cast<double>(t_ns) / 1e9; }

/// What acted on the robot in a frame.
struct FrameInputs {
  std::vector<robot::ActuatorCommand> cables;             ///< in the robot's order
  std::vector<force_estimation::ContactSite> loads = {};  ///< places of known loads
  bool contact_free = false;                              ///< counts for the depth bias
};

/// Forces from the images of one frame after the other: perception with the surface that the last
/// frame predicts, then force_estimation::ShapePipeline, as palpate-perception and
/// palpate-force-estimation do.
class ShapeStream {
 public:
  /// `body` must outlive the stream.
  ShapeStream(const robot::RobotBody& body, ReplayPerception perception,
              std::unique_ptr<force_estimation::ShapePipeline> pipeline);

  /// A sequence of frames of these cameras begins; nullopt: that camera has no image at all.
  /// `poses`: of all of them. Throws InputError for images of another size or lens than the depth
  /// bias is for.
  void Open(const std::vector<std::optional<rgbd::RgbdCamera>>& cameras,
            const force_estimation::CameraPoses& poses);
  /// The shape `x_m` [3n] in which the next frame is expected.
  void Expect(const Eigen::VectorXd& x_m) { pipeline_->Expect(x_m); }

  /// `images`: of each camera, nullptr where it has none of this time. Valid until the next call.
  const perception::JointObservation& Perceive(std::int64_t t_ns,
                                               const std::vector<const rgbd::RgbdFrame*>& images);
  /// The forces of the frame that was perceived last. Valid until the next call.
  const force_estimation::ForceEstimate& Estimate(FrameInputs inputs);

  /// Number of the sequence, from 1.
  std::uint32_t epoch() const { return epoch_; }
  std::vector<force_estimation::BiasSequence> JudgeBiasFrames() const {
    return pipeline_->JudgeBiasFrames();
  }

 private:
  ReplayPerception perception_;
  std::unique_ptr<force_estimation::ShapePipeline> pipeline_;
  Eigen::Matrix3Xi triangles_;
  std::uint32_t epoch_ = 0;
  force_estimation::CameraPoses poses_;
  std::vector<perception::PredictedSurface> predicted_;  ///< [cameras]
  const perception::JointObservation* observation_ = nullptr;
};

/// The observation in the robot's frame, without cables and time. `poses`: of all its cameras.
force_estimation::ShapeFrame MakeShapeFrame(const perception::JointObservation& observation,
                                            const force_estimation::CameraPoses& poses);

}  // namespace palpate::offline
