// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "components/perception/model/model_segmenter.hpp"
#include "components/perception/model/pixel_region.hpp"
#include "components/perception/observation.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::perception {

enum class Truth : char { kBackground, kRobot, kTool };

/// The four-legged robot of pushes.yaml before its camera, and what each pixel really shows.
class LabelledScene {
 public:
  explicit LabelledScene(const scenario::Scenario& scenario, std::uint64_t seed = 1);
  ~LabelledScene();

  /// The next frame.
  void Take(const virtual_camera::View& view);

  const rgbd::RgbdCamera& camera() const { return scenario_.camera->camera; }
  const rgbd::RgbdFrame& frame() const { return frame_; }
  /// Which pixels tell: those whose depth is of what is there, not mixed. Others count nowhere.
  bool Tells(int u_px, int v_px) const;
  Truth TruthAt(int u_px, int v_px) const;

 private:
  scenario::Scenario scenario_;
  std::unique_ptr<virtual_camera::VirtualCamera> camera_;
  std::unique_ptr<virtual_camera::VirtualCamera> without_tools_;
  std::unique_ptr<virtual_camera::VirtualCamera> robot_alone_;
  rgbd::RgbdFrame frame_;
  rgbd::RgbdFrame unused_;
};

/// pushes.yaml, with a body that is quick to solve; tools of any kind may be added.
scenario::Scenario PushScenario();
/// The body of `scenario` at `t_s` of its recording `name`, and the tools there: [3 x nodes].
virtual_camera::View PushedView(const scenario::Scenario& scenario, const std::string& recording,
                                double t_s);
const virtual_camera::RobotSurface& PushSkin();
/// The undeformed body, no tools.
virtual_camera::View RestView(const scenario::Scenario& scenario);

/// With the scenario's camera.
struct ReadySegmenter : ModelSegmenter {
  explicit ReadySegmenter(const scenario::Scenario& scenario, const Config& config = {})
      : ModelSegmenter(config) {
    SetCamera(scenario.camera->camera);
  }
};

/// The surface of `nodes_m` (robot frame) in the camera's frame, moved by `off_m` (camera frame).
PredictedSurface Predict(const scenario::Scenario& scenario, const Eigen::Matrix3Xd& nodes_m,
                         const Eigen::Vector3d& off_m = Eigen::Vector3d::Zero());

/// How well pixels were classified, of those with a known class.
struct Score {
  double robot_recall = 0.0;
  double robot_precision = 0.0;
  double tool_recall = 0.0;       ///< of the tools' pixels: found as object
  double object_precision = 0.0;  ///< of the object pixels: really a tool
  int robot_pixels = 0;
  int tool_pixels = 0;
  int object_pixels = 0;
  int mixed_pixels = 0;  ///< with a depth of nothing that is there
  int mixed_kept = 0;    ///< of them, those called robot or object
};
Score Compare(const LabelledScene& scene, const PixelRegion& region);

/// Robot red, objects green, mixed yellow, ambiguous violet, specks cyan, over the grey picture,
/// as `name`.png in the folder of the environment variable PALPATE_PICTURES; nothing without it.
void DrawLabels(const std::string& name, const LabelledScene& scene, const PixelRegion& region);

}  // namespace palpate::perception
