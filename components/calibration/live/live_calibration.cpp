// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/live_calibration.hpp"

#include <utility>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/cloud/join_frames.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/joint/request_after.hpp"
#include "components/calibration/live/earlier_calibration.hpp"
#include "components/calibration/pose/unlabelled_calibration.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/utc_text.hpp"

namespace palpate::calibration {

namespace {

template <typename Derived>
void AppendBytes(const Eigen::DenseBase<Derived>& numbers, std::string* bytes) {
  const auto plain = numbers.derived().eval();
  bytes->append(reinterpret_cast<const char*>(plain.data()),
                static_cast<std::size_t>(plain.size()) * sizeof(*plain.data()));
}

void AppendCables(const std::vector<robot::ActuatorCommand>& cables, std::string* bytes) {
  for (const robot::ActuatorCommand& cable : cables) {
    bytes->push_back(static_cast<char>(cable.kind));
    AppendBytes(Eigen::Matrix<double, 1, 1>(cable.value), bytes);
  }
}

void AppendSightings(const std::vector<MarkerSighting>& sightings, std::string* bytes) {
  for (const MarkerSighting& sighting : sightings) {
    AppendBytes(Eigen::Matrix<double, 1, 1>(sighting.marker), bytes);
    AppendBytes(sighting.position_m, bytes);
    AppendBytes(sighting.covariance_m2, bytes);
  }
}

void AppendClouds(const std::vector<CloudFrame>& frames, std::string* bytes) {
  for (const CloudFrame& frame : frames) {
    AppendBytes(frame.cloud.points_m, bytes);
    AppendBytes(frame.cloud.sigma_m, bytes);
    AppendCables(frame.cables, bytes);
  }
}

/// Over all numbers of the frames.
std::string HashOf(const LiveJob& job) {
  std::string bytes;
  AppendClouds(job.clouds, &bytes);
  for (const FurtherCameraJob& camera : job.further) AppendClouds(camera.clouds, &bytes);
  for (const CalibrationFrame& frame : job.markers) {
    AppendSightings(frame.markers, &bytes);
    AppendCables(frame.cables, &bytes);
  }
  for (const UnlabelledFrame& frame : job.points) {
    AppendSightings(frame.points, &bytes);
    AppendCables(frame.frame.cables, &bytes);
  }
  return "sha256-" + Sha256Hex(bytes);
}

/// With the cameras of `further` beside the first, at their initial poses.
CloudSettings SettingsOf(const LiveJob& job, const std::vector<FurtherCameraJob>& further) {
  CloudSettings settings;
  settings.request = job.request;
  settings.fit_depth_bias = job.fit_depth_bias && job.picture;
  settings.search.stop = job.request.stop;
  for (const FurtherCameraJob& camera : further) {
    settings.further_cameras.push_back({.name = camera.name,
                                        .T_robot_camera_start = camera.T_robot_camera_start,
                                        .fit_depth_bias = job.fit_depth_bias && camera.picture});
  }
  return settings;
}

JointCalibration Fit(robot::RobotModel& model, const LiveJob& job,
                     const std::vector<FurtherCameraJob>& further, LiveResult* result) {
  const geometry::RigidTransform* start =
      job.T_robot_camera_start ? &*job.T_robot_camera_start : nullptr;
  if (!job.points.empty()) {
    UnlabelledSettings settings;
    settings.request = job.request;
    settings.T_robot_camera_last = job.T_robot_camera_last;
    UnlabelledCalibration fit = CalibrateUnlabelled(model, job.points, start, settings);
    fit.joint.status = fit.status;
    result->left_out = std::move(fit.left_out);
    result->decided_by_last_pose = fit.decided_by_last_pose;
    return std::move(fit.joint);
  }
  if (job.clouds.empty()) return CalibrateFrames(model, job.markers, start, job.request);
  if (start == nullptr) {
    JointCalibration refused;
    refused.status = {StatusCode::kNoCalibration, "clouds need an approximate camera pose"};
    return refused;
  }
  std::vector<std::vector<CloudFrame>> of_further;
  for (const FurtherCameraJob& camera : further) of_further.push_back(camera.clouds);
  CloudCalibration fit = CalibrateFromClouds(model, JoinFrames(job.clouds, of_further), *start,
                                             SettingsOf(job, further));
  fit.joint.status = fit.status;
  return std::move(fit.joint);
}

/// Of a model with the last calibration. `read`: the job with its frames read as that has them.
JointCalibration FitAsBefore(robot::RobotModel& model, const LiveJob& read,
                             const std::vector<FurtherCameraJob>& further, LiveResult* result) {
  const ModelSnapshot kept(model);
  if (read.before) {
    robot::CalibrationFile body = *read.before;
    body.drives.clear();  // already applied to the frames, as the pressure sensors
    robot::ApplyCalibration(body, &model);
  }
  JointCalibration fit = Fit(model, read, further, result);
  kept.Restore();
  return fit;
}

/// The calibration of a fit. `model` as the robot file has it.
robot::CalibrationFile FileOf(const LiveJob& job, const JointCalibration& fit,
                              robot::RobotModel& model) {
  robot::CalibrationFile file = robot::DescribeForCalibration(model);
  file.date_utc = UtcText(job.found_ns_since_1970 / 1'000'000'000);
  file.data = job.data;
  file.data_hash = HashOf(job);
  const ModelSnapshot kept(model);
  if (job.before && job.before->gravity) model.SetGravity(job.before->gravity->gravity_m_s2);
  TakeFit(fit, model, &file);
  kept.RestoreGravity();
  if (job.picture) TakeDepthBias(fit, *job.picture, &file);
  if (job.before) KeepFromBefore(*job.before, &file);
  return file;
}

/// Pose and depth bias of a further camera, for the robot that `file` describes.
Status FitFurtherCamera(robot::RobotModel& model, const LiveJob& job, FurtherCameraJob camera,
                        const robot::CalibrationFile& file, robot::CalibratedCamera* found) {
  ReadAsBefore(file, model, &camera.clouds);
  CloudSettings settings;
  settings.request = RequestAfter(file);
  settings.request.stop = settings.search.stop = job.request.stop;
  settings.fit_depth_bias = job.fit_depth_bias && camera.picture;
  const CloudCalibration fit =
      CalibrateFromClouds(model, camera.clouds, camera.T_robot_camera_start, settings);
  if (!fit.status.ok()) return fit.status;
  *found = CameraOf(camera.name, fit.joint, camera.picture);
  return Status::Ok();
}

/// Returns those that were found, at their poses.
std::vector<FurtherCameraJob> CalibrateFurther(robot::RobotModel& model, const LiveJob& job,
                                               LiveResult* result) {
  robot::CalibrationFile body = result->file;
  body.drives.clear();  // applied to the frames, as the pressure sensors
  const ModelSnapshot nominal(model);
  std::vector<FurtherCameraJob> cameras;
  for (const FurtherCameraJob& camera : job.further) {
    if (camera.clouds.empty()) {
      result->left_out.push_back("camera '" + camera.name + "': it did not see the robot");
      continue;
    }
    robot::ApplyCalibration(body, &model);
    robot::CalibratedCamera found;
    const Status status = FitFurtherCamera(model, job, camera, result->file, &found);
    nominal.Restore();
    if (status.ok()) {
      const Eigen::Isometry3d& T = found.pose.T_robot_camera;
      cameras.push_back(camera);
      cameras.back().T_robot_camera_start = {Eigen::Quaterniond(T.linear()), T.translation()};
      result->file.cameras.push_back(std::move(found));
    } else {
      result->left_out.push_back("camera '" + camera.name + "': " + status.message());
    }
  }
  return cameras;
}

/// Replaces what the cameras tell one after the other by what they tell together.
void CalibrateAll(robot::RobotModel& model, const LiveJob& job, const LiveJob& read,
                  const JointCalibration& first, const std::vector<FurtherCameraJob>& further,
                  LiveResult* result) {
  const JointCalibration fit = FitAsBefore(model, read, further, result);

  if (!fit.status.ok() || !AgreesWith(first, fit)) {
    const std::string why = fit.status.ok() ? "they contradict each other" : fit.status.message();
    result->left_out.push_back("one fit of all cameras: " + why);
    return;
  }
  result->file = FileOf(job, fit, model);
  result->pose_covariance = fit.pose_covariance;
  for (std::size_t k = 0; k < further.size(); ++k) {
    result->file.cameras.push_back(
        CameraOf(further[k].name, fit.further_cameras[k], further[k].picture));
  }
}

}  // namespace

LiveResult CalibrateLive(robot::RobotModel& model, const LiveJob& job) {
  LiveResult result;
  LiveJob read = job;
  if (job.before) {
    result.status = robot::CheckCalibration(*job.before, model);
    if (!result.status.ok()) return result;
    ReadAsBefore(*job.before, model, &read.clouds);
    ReadAsBefore(*job.before, model, &read.markers);
    ReadAsBefore(*job.before, model, &read.points);
  }
  const JointCalibration fit = FitAsBefore(model, read, {}, &result);
  result.status = fit.status;
  if (!fit.status.ok()) return result;
  result.file = FileOf(job, fit, model);
  result.pose_covariance = fit.pose_covariance;
  const std::vector<FurtherCameraJob> further = CalibrateFurther(model, job, &result);
  if (!further.empty()) CalibrateAll(model, job, read, fit, further, &result);
  if (job.before) KeepCamerasFromBefore(*job.before, &result.file);
  return result;
}

}  // namespace palpate::calibration
