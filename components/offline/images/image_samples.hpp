// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// A frame that calibration uses, and what acted on the robot at its time.
struct ImageSample {
  const experiment::RgbdSequence* images = nullptr;
  std::size_t index = 0;          ///< into its frames
  calibration::CloudFrame frame;  ///< without its cloud
};

/// Of a recording whose cables do not move, or in its steady window, the middle frame; of a moving
/// one up to `most`, spread over its time. `images` must outlive them. Throws InputError where a
/// load lies off the body, or no image lies in a steady window.
std::vector<ImageSample> SamplesOf(const experiment::Recording& recording,
                                   const experiment::RgbdSequence& images,
                                   const robot::RobotModel& model, robot::CableInput preferred,
                                   std::size_t most = 6);

/// The frame `index` of `images`, named `name`, and what acted then. `images` must outlive it.
/// Throws InputError where a load lies off the body.
ImageSample SampleAt(const experiment::Recording& recording, const experiment::RgbdSequence& images,
                     std::size_t index, const std::string& name, const robot::RobotModel& model,
                     robot::CableInput preferred);

/// [3n] nodes of the model under the samples' inputs. The model is unchanged. Throws RunError where
/// there is no equilibrium.
std::vector<Eigen::VectorXd> ShapesOf(const std::vector<ImageSample>& samples,
                                      robot::RobotModel* model);

}  // namespace palpate::offline
