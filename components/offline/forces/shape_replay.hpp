// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/pipeline/shape_pipeline.hpp"
#include "components/offline/forces/marker_replay.hpp"
#include "components/offline/forces/shape_stream.hpp"
#include "components/offline/images/image_opener.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/joint_frames.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// Passes depth and colour images of recordings through perception and
/// force_estimation::ShapePipeline, as palpate-perception and palpate-force-estimation do. All
/// recordings share one perception and one pipeline: the depth bias of one holds for the next.
/// Frames of several cameras are joined by their times; a camera that is missing, or whose pose is
/// unknown, costs accuracy only.
class ShapeReplay {
 public:
  struct Inputs {
    const experiment::Experiment& experiment;  ///< must outlive the replay, as the model
    robot::RobotModel* model = nullptr;        ///< of the pipeline
    robot::CableInput cable_input = robot::CableInput::kDisplacement;
    ReplayLimits limits{};  ///< contact-free recordings are not thinned
    /// Each recording begins with the posture that its commands give, so that its first frame has a
    /// predicted surface. False: with the shape of the frame before, as palpate-force-estimation.
    bool expect_posture = true;
    ImageOpener open{};
  };

  ShapeReplay(const Inputs& inputs, ShapeStream stream);

  /// Processes the frames of a contact-free recording for the depth bias. Returns their number; 0
  /// where the camera pose is unknown. Throws InputError as Estimate does.
  int EstimateDepthBias(const experiment::Recording& recording);
  struct FirstFrames {
    int frames = 0;
    bool ends_with_contact = false;  ///< perception locates a contact in the next frame
  };
  /// The same for a recording that may have contacts: its first frames, up to `most`, as long as
  /// perception locates no contact.
  FirstFrames EstimateDepthBiasFromStart(const experiment::Recording& recording, int most);

  /// A contact-free recording whose frames were processed for the depth bias.
  struct BiasRecording {
    const experiment::Recording* recording = nullptr;
    force_estimation::BiasSequence verdict;
  };
  /// Whether they were contact-free, in the order of processing.
  std::vector<BiasRecording> JudgeBiasRecordings() const;

  /// Hands the estimate of each frame to `take`; kNoCalibration, with the reason, where the camera
  /// pose is unknown. Throws InputError for images that cannot be read, and for a cable that the
  /// robot does not have.
  ReplayCount Estimate(const experiment::Recording& recording, const TakeEstimate& take);

  /// What there is to say of the cameras since the last call: which were not used, and in how many
  /// frames they were missing.
  std::vector<std::string> TakeNotes() { return std::exchange(notes_, {}); }

 private:
  struct SceneCamera;
  struct Scene;

  /// The frames of a recording that are processed, and as what.
  struct Frames {
    bool contact_free = false;
    bool until_contact = false;  ///< as long as perception locates none
    int most = std::numeric_limits<int>::max();
  };

  FirstFrames EstimateDepthBias(const experiment::Recording& recording, const Frames& frames);
  Scene Open(const experiment::Recording& recording);
  ReplayCount Run(const Scene& scene, const Frames& frames, const TakeEstimate& take);
  void ExpectPosture(const Scene& scene);
  FrameInputs InputsAt(const Scene& scene, std::int64_t t_ns, bool contact_free) const;
  const perception::JointObservation& Perceive(const Scene& scene,
                                               const experiment::JointFrame& joint);
  void NoteMissing(const Scene& scene, const std::vector<std::size_t>& frames);

  Inputs inputs_;
  std::vector<std::string> names_;                ///< of the cameras beside the first
  std::vector<experiment::Experiment> of_names_;  ///< as each of them alone recorded it
  ShapeStream stream_;
  Eigen::Vector3d gravity_m_s2_;
  std::vector<rgbd::RgbdFrame> frames_;  ///< [cameras] the last ones that were read
  std::vector<std::string> notes_;
  std::map<std::uint32_t, const experiment::Recording*> bias_recordings_;  ///< by epoch
};

}  // namespace palpate::offline
