// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/recording_writer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/experiment/recording_settings.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;
using experiment::ActuatorColumn;
using experiment::ActuatorQuantity;

std::optional<double> Sample(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The content of recording.yaml: the plan, without the hidden effects.
experiment::Recording Settings(const scenario::RecordingPlan& plan) {
  experiment::Recording recording;
  recording.name = plan.name;
  recording.kind = experiment::ParseRecordingKind(plan.kind, plan.location);
  if (!plan.base_tilt_deg.isZero(0.0)) recording.base_tilt_deg = plan.base_tilt_deg;
  recording.T_robot_camera = plan.T_robot_camera;
  recording.notes = plan.notes;
  return recording;
}

}  // namespace

RecordingWriter::RecordingWriter(const robot::RobotDescription& robot,
                                 const scenario::Scenario& scenario,
                                 const scenario::RecordingPlan& plan, fs::path folder)
    : recording_{Settings(plan)},
      robot_{robot},
      scenario_{scenario},
      plan_{plan},
      folder_{std::move(folder)} {
  experiment::CreateFolder(folder_);
  if (scenario.TakesPictures()) {
    cameras_.push_back({folder_, 0});
    for (const scenario::FurtherCamera& camera : scenario.further_cameras) {
      cameras_.push_back(
          {folder_ / "cameras" / camera.name, std::llround(1e9 * camera.clock_offset_s)});
    }
  }
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const rgbd::RgbdCamera camera = scenario.WithCamera(k).camera->camera;
    experiment::CreateFolder(cameras_[k].folder / "depth");
    if (camera.color.width_px > 0) experiment::CreateFolder(cameras_[k].folder / "color");
    if (k > 0) WriteFile(cameras_[k].folder / "camera.yaml", rgbd::FormatCameraFile(camera));
  }
  for (const robot::CableSettings& cable : robot.cables) {
    for (const ActuatorQuantity quantity :
         {ActuatorQuantity::kDisplacement, ActuatorQuantity::kTension}) {
      actuation_.columns.push_back(
          {.cable = cable.name, .quantity = quantity, .samples = {}, .where = {}});
    }
  }
  for (const robot::ChamberSettings& chamber : robot.chambers) {
    for (const ActuatorQuantity quantity :
         {ActuatorQuantity::kDisplacement, ActuatorQuantity::kTension}) {
      actuation_.columns.push_back({.cable = chamber.name,
                                    .quantity = quantity,
                                    .samples = {},
                                    .where = {},
                                    .of_chamber = true});
    }
  }
  for (const robot::MarkerSettings& marker : robot.markers) markers_.names.push_back(marker.name);
}

void RecordingWriter::AddCables(double t_s,
                                const std::vector<virtual_robot::CableReading>& readings) {
  PALPATE_CHECK(2 * readings.size() == actuation_.columns.size(), readings.size());
  actuation_.t_s.push_back(t_s);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const bool driven = std::isfinite(readings[i].displacement_m);
    const bool of_chamber = actuation_.columns[2 * i].of_chamber;
    const double least = of_chamber ? readings[i].tension_N : 0.0;
    const double tension_N =
        driven ? std::max(least, readings[i].tension_N) : readings[i].displacement_m;
    actuation_.columns[2 * i].samples.push_back(Sample(readings[i].displacement_m));
    actuation_.columns[2 * i + 1].samples.push_back(Sample(tension_N));
  }
}

void RecordingWriter::AddMarkers(double t_s, const Eigen::Matrix3Xd& positions_m,
                                 scenario::Random* noise) {
  PALPATE_CHECK(positions_m.cols() == ToIndex(markers_.names.size()), positions_m.cols());
  experiment::MarkerFrame frame;
  frame.t_s = t_s;
  for (Eigen::Index i = 0; i < positions_m.cols(); ++i) {
    Eigen::Vector3d seen_m = positions_m.col(i);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      seen_m[axis] += scenario_.markers->sigma_m[axis] * noise->Normal();
    }
    const double missing_share = scenario_.markers->missing_share;
    const bool missing = missing_share > 0.0 && noise->Uniform() < missing_share;
    const bool seen = !missing && seen_m.allFinite();
    frame.positions_m.push_back(seen ? std::optional(seen_m) : std::nullopt);
  }
  markers_.frames.push_back(std::move(frame));
}

void RecordingWriter::AddImage(std::size_t camera, const rgbd::RgbdFrame& frame) {
  const auto& [folder, clock_offset_ns] = cameras_.at(camera);
  const std::string name = std::to_string(frame.stamp_ns + clock_offset_ns) + ".png";
  rgbd::WriteDepthPng(folder / "depth" / name, frame.depth);
  if (!frame.color.empty()) rgbd::WriteColorPng(folder / "color" / name, frame.color);
}

void RecordingWriter::Finish(double begin_s) {
  std::erase_if(actuation_.columns, [](const ActuatorColumn& column) {
    return std::none_of(column.samples.begin(), column.samples.end(),
                        [](const std::optional<double>& sample) { return sample.has_value(); });
  });
  if (!actuation_.columns.empty()) {
    experiment::WriteActuation(actuation_, folder_ / "actuation.csv");
  }
  if (!markers_.frames.empty()) experiment::WriteMarkers(markers_, folder_ / "markers.csv");
  const auto loads = DeclaredLoads(plan_, robot_.gravity_m_s2, begin_s);
  if (!loads.empty()) experiment::WriteLoads(loads, folder_ / "loads.csv");
  if (scenario_.camera) {
    WriteFile(folder_ / "camera.yaml", rgbd::FormatCameraFile(scenario_.camera->camera));
  }
  WriteFile(folder_ / "recording.yaml", experiment::FormatRecordingSettings(recording_));
}

std::vector<experiment::KnownLoad> DeclaredLoads(const scenario::RecordingPlan& plan,
                                                 const Eigen::Vector3d& gravity_m_s2,
                                                 double begin_s) {
  std::vector<experiment::KnownLoad> loads;
  const Eigen::Vector3d gravity_robot_m_s2 =
      experiment::BaseRotation(Settings(plan)).transpose() * gravity_m_s2;
  for (const scenario::HungWeight& weight : plan.weights) {
    experiment::KnownLoad load;
    load.t_s = begin_s + weight.t_s;
    load.position_m = weight.position_m;
    load.force_N = weight.mass_kg * gravity_robot_m_s2;
    load.patch_radius_m = weight.patch_radius_m;
    loads.push_back(load);
  }
  // Rows of one single time would hold throughout the recording.
  if (!loads.empty() && plan.weights.front().t_s > 0.0) {
    experiment::KnownLoad none = loads.front();
    none.t_s = begin_s;
    none.force_N.setZero();
    loads.insert(loads.begin(), none);
  }
  return loads;
}

}  // namespace palpate::command
