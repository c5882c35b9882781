// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/palpate/estimate/marker_pipeline.hpp"
#include "components/palpate/estimate/shape_senses.hpp"
#include "libs/core/status.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Forces from depth and colour of recordings: what palpate-perception and palpate-force-estimation
/// do with the same frames, without DDS between them. One pair of senses for the whole experiment:
/// what they learn from one recording holds for the next.
class ShapePipeline {
 public:
  struct Inputs {
    const experiment::Experiment& experiment;  ///< must outlive the way, as the model
    robot::RobotModel* model = nullptr;
    robot::CableInput cable_input = robot::CableInput::kDisplacement;
    std::vector<force_estimation::ContactSite> sites;  ///< given; empty: those of known loads
    /// So many frames at the start in which the robot is seen are known to be untouched, as
    /// palpate-force-estimation takes them.
    int first_untouched = 0;
  };

  ShapePipeline(const Inputs& inputs, ShapeSenses senses);

  /// Takes the frames of a recording in which nobody touches the robot. Returns how many; 0 where
  /// nobody says where the camera was.
  int Teach(const experiment::Recording& recording);

  /// Hands the estimate of each frame to `take`; kNoCalibration, with the reason, where nobody says
  /// where the camera was. Throws InputError for images that cannot be read, and for a cable that
  /// the robot does not have.
  void Estimate(const experiment::Recording& recording, const TakeEstimate& take);

 private:
  struct Scene;

  void Run(const Scene& scene, bool untouched, const TakeEstimate& take);
  const force_estimation::ForceEstimate& Step(const Scene& scene, const rgbd::RgbdFrame& frame,
                                              bool untouched);
  std::vector<robot::CableCommand> CablesAt(const experiment::Recording& recording,
                                            double t_s) const;
  std::vector<force_estimation::SeenContact> KnownContactsAt(const experiment::Recording& recording,
                                                             double t_s) const;

  Inputs inputs_;
  ShapeSenses senses_;
  force_estimation::KnownContacts known_contacts_;
  Eigen::Matrix3Xi triangles_;
  Eigen::Vector3d gravity_m_s2_;
  Eigen::Matrix3Xf nodes_m_;  ///< of the last estimate that stands, as it would travel; or none
  force_estimation::ForceEstimate unseen_;  ///< of a frame that perception refused
  std::uint32_t epoch_ = 0;                 ///< recordings that were opened
  int frames_ = 0;
  int frames_seen_ = 0;  ///< in which perception found the robot
};

/// What was seen, in the robot's frame; without cables and time.
force_estimation::ShapeFrame MakeShapeFrame(const perception::Observation& observation,
                                            const Eigen::Isometry3d& T_robot_camera);

}  // namespace palpate::command
