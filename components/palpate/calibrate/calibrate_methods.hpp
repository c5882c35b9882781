// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/offline/images/image_samples.hpp"
#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Young's moduli of `materials` (RobotBody::materials) from static phases with known loads.
robot::CalibrationFile CalibrateMaterial(const CalibrateOptions& options,
                                         const experiment::Experiment& experiment,
                                         const std::vector<int>& materials,
                                         robot::RobotModel* model);

/// Whether a suitable recording has markers in the camera's frame.
bool HasMarkersOfTheCamera(const experiment::Experiment& experiment);

/// Whether a suitable recording has depth images.
bool HasImagesOfTheCamera(const experiment::Experiment& experiment);

/// What the markers of recordings give.
struct MarkerCalibration {
  std::vector<const experiment::Recording*> recordings;
  std::vector<calibration::CalibrationFrame> frames;
  calibration::JointRequest request;
  calibration::JointCalibration fit;
};
/// The model has the estimates.
MarkerCalibration FitRecordedMarkers(const CalibrateOptions& options,
                                     const experiment::Experiment& experiment,
                                     const std::vector<int>& materials, robot::RobotModel* model);
/// The file, printed but with --json.
robot::CalibrationFile Describe(const MarkerCalibration& found, const CalibrateOptions& options,
                                const robot::RobotModel& model);

/// Removes offsets of markers that were not asked for from what is undetermined.
void LeaveOutMarkerOffsets(const CalibrateOptions& options, robot::CalibrationFile* file);
/// Adds those moduli of another fit's `undetermined` that `file` says nothing of: it did not ask.
void TakeUndeterminedModuli(const std::vector<robot::Undetermined>& undetermined,
                            robot::CalibrationFile* file);

/// The recordings with images of one camera, and those of their frames that calibration uses.
struct CameraImages {
  std::vector<const experiment::Recording*> recordings;
  std::vector<experiment::RgbdSequence> sequences = {};
  std::vector<offline::ImageSample> samples = {};
};
/// Inputs are as `model` corrects them. Throws InputError where no recording is suitable.
CameraImages OpenCameraImages(const CalibrateOptions& options,
                              const experiment::Experiment& experiment,
                              const robot::RobotModel& model);

/// What the clouds of images give.
struct ImageCalibration {
  std::vector<const experiment::Recording*> recordings;
  geometry::DepthPicture picture;  ///< of the first recording's images
  std::vector<calibration::CloudFrame> frames;
  calibration::CloudSettings clouds;  ///< of the fit
  calibration::CloudCalibration fit;
};
/// From the approximate pose `start`; `clouds` without fit_depth_bias. The model has the estimates,
/// and is unchanged where an error is thrown.
ImageCalibration FitImages(const CalibrateOptions& options,
                           const experiment::Experiment& experiment, const Eigen::Isometry3d& start,
                           calibration::CloudSettings clouds, robot::RobotModel* model);
/// The file, printed but with --json.
robot::CalibrationFile Describe(const ImageCalibration& found, const CalibrateOptions& options,
                                const robot::RobotModel& model);

/// Actuator offsets, gravity and the moduli of `materials` (empty: not estimated) from markers,
/// with the camera pose where they were measured in its frame.
robot::CalibrationFile CalibrateJointly(const CalibrateOptions& options,
                                        const experiment::Experiment& experiment,
                                        const std::vector<int>& materials,
                                        robot::RobotModel* model);

/// A calibration, and the fit to the first camera's images where it is from them.
struct FoundCalibration {
  robot::CalibrationFile file;
  std::optional<ImageCalibration> images = {};
};

/// The same from depth and colour without markers: from the robot's point clouds, segmented first
/// with the approximate pose, then with the estimated one.
FoundCalibration CalibrateFromImages(const CalibrateOptions& options,
                                     const experiment::Experiment& experiment,
                                     const std::vector<int>& materials, robot::RobotModel* model);

/// Adds the poses and depth biases of the cameras beside the first: each from its own images,
/// against the robot of the calibration `found`, then, where that is from images, all in one fit
/// that replaces `found`. A camera without images or an approximate pose is left out, which is
/// printed, as is why one fit of all failed. Throws RunError where the images of one do not fit.
/// `model` as the robot file has it.
void CalibrateFurtherCameras(const CalibrateOptions& options,
                             const experiment::Experiment& experiment, robot::RobotModel* model,
                             FoundCalibration* found);

/// From named markers and from images in one fit. Images without an approximate camera pose are
/// left out, which is printed. Throws RunError where one of both does not fit, or they contradict
/// each other.
FoundCalibration CalibrateTogether(const CalibrateOptions& options,
                                   const experiment::Experiment& experiment,
                                   const std::vector<int>& materials, robot::RobotModel* model);

/// Whether the points of the recordings have no marker names, or --unlabelled ignores them.
bool AreUnlabelled(const CalibrateOptions& options, const experiment::Experiment& experiment);

/// As CalibrateJointly in the camera's frame, from points without names.
robot::CalibrationFile CalibrateFromUnlabelled(const CalibrateOptions& options,
                                               const experiment::Experiment& experiment,
                                               const std::vector<int>& materials,
                                               robot::RobotModel* model);

/// The same from the fiducials that depth and colour images show.
robot::CalibrationFile CalibrateFromFiducials(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment,
                                              const std::vector<int>& materials,
                                              robot::RobotModel* model);

/// The parameters and priors of a joint calibration; `camera`: with the camera pose.
calibration::JointRequest RequestOf(const CalibrateOptions& options,
                                    const experiment::Experiment& experiment,
                                    const std::vector<int>& materials, bool camera);

/// The recordings that are named, or all that are suitable: for `camera` those that it sees.
/// Throws InputError where none is.
std::vector<const experiment::Recording*> ChosenRecordings(const CalibrateOptions& options,
                                                           const experiment::Experiment& experiment,
                                                           bool camera);

}  // namespace palpate::command
