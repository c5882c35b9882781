// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/camera_faults.hpp"

#include <cmath>
#include <string>

#include "libs/scenario/random.hpp"

namespace palpate::virtual_camera {

namespace {

CameraFaults::Move MakeMove(const scenario::ActiveEffect& effect, std::uint64_t seed,
                            std::size_t number) {
  scenario::Random random(seed, "virtual_camera camera_moved " + std::to_string(number));
  const Eigen::Vector3d along = random.Direction();
  const Eigen::Vector3d axis = random.Direction();
  CameraFaults::Move move;
  move.from_recording = static_cast<int>(std::lround(effect.Get("from_recording")));
  move.T_before_after.linear() =
      Eigen::AngleAxisd(effect.Get("rotation_rad"), axis).toRotationMatrix();
  move.T_before_after.translation() = effect.Get("translation_m") * along;
  return move;
}

}  // namespace

Eigen::Isometry3d CameraFaults::MovedPose(const Eigen::Isometry3d& T_robot_camera,
                                          int recording) const {
  Eigen::Isometry3d pose = T_robot_camera;
  for (const Move& move : moves) {
    if (recording >= move.from_recording) pose = pose * move.T_before_after;
  }
  return pose;
}

double CameraFaults::DriftAt(double t_s) const {
  double sum = 0.0;
  for (const Drift& drift : drifts) sum += drift.amplitude_m * (1.0 - std::exp(-t_s / drift.tau_s));
  return sum;
}

rgbd::CameraModel CameraFaults::TrueDepthCamera(const rgbd::CameraModel& data_sheet) const {
  rgbd::CameraModel camera = data_sheet;
  camera.fx_px *= 1.0 + focal;
  camera.fy_px *= 1.0 + focal;
  camera.cx_px += cx_px;
  camera.cy_px += cy_px;
  camera.distortion[0] += k1;
  return camera;
}

CameraFaults FaultsFrom(const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed) {
  CameraFaults faults;
  for (const scenario::ActiveEffect& effect : effects) {
    if (effect.id == "camera_moved") {
      faults.moves.push_back(MakeMove(effect, seed, faults.moves.size()));
    } else if (effect.id == "depth_scale") {
      faults.depth_scale += effect.Get("s");
    } else if (effect.id == "depth_incidence_bias") {
      faults.incidence_bias_m += effect.Get("b_m");
    } else if (effect.id == "intrinsics") {
      faults.focal += effect.Get("focal");
      faults.cx_px += effect.Get("cx_px");
      faults.cy_px += effect.Get("cy_px");
    } else if (effect.id == "lens_distortion") {
      faults.k1 += effect.Get("k1");
    } else if (effect.id == "flying_pixels") {
      faults.flying_pixel_ratio += effect.Get("ratio");
    } else if (effect.id == "warm_up_drift") {
      faults.drifts.push_back({effect.Get("amplitude_m"), effect.Get("tau_s")});
    }
  }
  return faults;
}

}  // namespace palpate::virtual_camera
