// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

enum class TrueLabel : char { kElse, kRobot };

/// What perception would give if it knew the truth: for tests of what comes after it, and to
/// measure it by. For cameras without faults in pose and lens.
class IdealPerception {
 public:
  explicit IdealPerception(const SensingScene& scene, std::size_t camera = 0);

  /// [pixels] what is really in each depth pixel of the scene's last frame. Holds until the next
  /// call.
  const std::vector<TrueLabel>& Labels();

  /// The robot's points of the scene's last frame: noisy as the depth image is, without those at
  /// depth edges, averaged over blocks of 2 x 2 pixels.
  rgbd::SensedCloud Cloud();

  /// What is added to the true place of a contact, m.
  using LocationError = std::function<Eigen::Vector3d(const std::string& name)>;

  /// A contact for each tool that touches, `weights` too: for each that hangs. Its true centre of
  /// pressure and an error, with the covariance of one of `sigma_m` along each axis, without an
  /// extent.
  std::vector<force_estimation::SeenContact> Contacts(double sigma_m, const LocationError& error,
                                                      bool weights = false) const;

  /// What the camera sees of the last frame, as the estimator gets it.
  force_estimation::ShapeView View();
  /// The last frame with this camera alone. `contacts`: seen ones.
  force_estimation::ShapeFrame Frame(std::vector<force_estimation::SeenContact> contacts);

 private:
  bool IsWellInside(int u_px, int v_px) const;

  const SensingScene& scene_;
  std::size_t camera_;
  rgbd::DepthNoise noise_;
  rgbd::SurfaceView view_;
  std::vector<TrueLabel> labels_;
};

}  // namespace palpate::test_support
