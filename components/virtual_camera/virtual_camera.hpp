// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/scenario/bench_inputs.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_camera {

/// The robot's surface as it is drawn.
struct RobotSurface {
  Eigen::Matrix3Xd rest_m;     ///< [3 x nodes] robot frame; colours and marker discs stick to it
  Eigen::Matrix3Xi triangles;  ///< [3 x k] corners, anticlockwise from outside
  Eigen::Matrix3Xd markers_m;  ///< [3 x markers] rest positions of the coloured discs
};

using ToolPose = scenario::ToolPose;

/// What is in front of the camera at one instant.
struct View {
  double t_s = 0.0;          ///< since the camera was switched on (drift)
  Eigen::Matrix3Xd nodes_m;  ///< [3 x nodes] robot frame
  std::vector<ToolPose> tools;
  /// True pose of the depth camera, before effects; p_robot = T_robot_camera * p_camera.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  int recording = 0;  ///< number of the recording (camera_moved acts from one on)
};

/// The virtual RGB-D camera: draws what a perfect camera would see, then spoils it as a real one
/// does. The same seed and views give the same bits.
class VirtualCamera {
 public:
  /// Throws InputError without a camera in the scenario. Only effects of the camera act here.
  VirtualCamera(const scenario::Scenario& scenario, RobotSurface robot_surface,
                const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed);
  ~VirtualCamera();

  /// The next frame; `stamp_ns` is left to the caller. Buffers of `frame` are used again.
  void Take(const View& view, rgbd::RgbdFrame* frame);

  /// z of what is really there in every pixel of the last Take, m, before noise; NaN: nothing.
  const rgbd::RangeImage& true_range() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The camera of that number, 0 the scenario's camera, then its further ones, with noise and bias
/// of its own. Effects act on the first.
std::unique_ptr<VirtualCamera> MakeCamera(const scenario::Scenario& scenario, std::size_t number,
                                          const RobotSurface& robot_surface,
                                          const std::vector<scenario::ActiveEffect>& effects,
                                          std::uint64_t seed);
/// All of them, in this order.
std::vector<std::unique_ptr<VirtualCamera>> MakeCameras(
    const scenario::Scenario& scenario, const RobotSurface& robot_surface,
    const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed);

}  // namespace palpate::virtual_camera
