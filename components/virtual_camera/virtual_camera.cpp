// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/virtual_camera.hpp"

#include <optional>
#include <string>
#include <utility>

#include "components/virtual_camera/camera_faults.hpp"
#include "components/virtual_camera/color_sensor.hpp"
#include "components/virtual_camera/depth_sensor.hpp"
#include "components/virtual_camera/scenery.hpp"
#include "libs/core/error.hpp"

namespace palpate::virtual_camera {

namespace {

void CheckModel(const rgbd::CameraModel& model, const char* which) {
  if (model.width_px > 0 && model.height_px > 0 && model.fx_px > 0.0 && model.fy_px > 0.0) return;
  throw InputError(std::string("the scenario's ") + which +
                   " camera has no size or no focal length");
}

const scenario::CameraSpec& SpecOf(const scenario::Scenario& scenario) {
  if (!scenario.camera) throw InputError("the scenario has no camera");
  const rgbd::RgbdCamera& camera = scenario.camera->camera;
  CheckModel(camera.depth, "depth");
  if (camera.color.width_px != 0) CheckModel(camera.color, "colour");
  return *scenario.camera;
}

}  // namespace

struct VirtualCamera::Parts {
  Parts(const scenario::Scenario& scenario, RobotSurface robot_surface, CameraFaults camera_faults,
        std::uint64_t seed)
      : spec{SpecOf(scenario)},
        faults{std::move(camera_faults)},
        scenery{scenario, std::move(robot_surface)},
        depth_camera{faults.TrueDepthCamera(spec.camera.depth), kernels::BestKernels()},
        depth_sensor{spec, faults, seed, kernels::BestKernels()},
        truth{spec.camera.depth.width_px, spec.camera.depth.height_px} {
    if (spec.camera.color.width_px == 0) return;
    const bool registered = spec.camera.color_registered;
    const rgbd::CameraModel& model = registered ? depth_camera.camera() : spec.camera.color;
    color_sensor.emplace(model, seed, kernels::BestKernels());
    if (!registered) color_camera.emplace(model, kernels::BestKernels());
  }

  scenario::CameraSpec spec;
  CameraFaults faults;
  Scenery scenery;
  SceneCamera depth_camera;
  std::optional<SceneCamera> color_camera;  // beside the depth camera
  DepthSensor depth_sensor;
  std::optional<ColorSensor> color_sensor;
  rgbd::RangeImage truth;
};

VirtualCamera::VirtualCamera(const scenario::Scenario& scenario, RobotSurface robot_surface,
                             const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed)
    : parts_{std::make_unique<Parts>(scenario, std::move(robot_surface), FaultsFrom(effects, seed),
                                     seed)} {}

VirtualCamera::~VirtualCamera() = default;

void VirtualCamera::Take(const View& view, rgbd::RgbdFrame* frame) {
  Parts& parts = *parts_;
  const Eigen::Isometry3d T_robot_depth =
      parts.faults.MovedPose(view.T_robot_camera, view.recording);
  const Drawing& drawing = parts.scenery.Update(view);
  parts.depth_camera.Look(drawing, T_robot_depth);
  parts.depth_sensor.Measure(&parts.depth_camera, view.t_s, &parts.truth, &frame->depth);
  if (!parts.color_sensor) {
    frame->color = {};
    return;
  }
  if (parts.color_camera) {
    parts.color_camera->Look(drawing, T_robot_depth * parts.spec.camera.T_depth_color);
  }
  SceneCamera& eye = parts.color_camera ? *parts.color_camera : parts.depth_camera;
  parts.color_sensor->Expose(&eye, &frame->color);
}

const rgbd::RangeImage& VirtualCamera::true_range() const { return parts_->truth; }

std::unique_ptr<VirtualCamera> MakeCamera(const scenario::Scenario& scenario, std::size_t number,
                                          const RobotSurface& robot_surface,
                                          const std::vector<scenario::ActiveEffect>& effects,
                                          std::uint64_t seed) {
  constexpr std::uint64_t kApart = 0x9E3779B97F4A7C15;  // of seeds, that no two runs share one
  const auto& acting = number == 0 ? effects : std::vector<scenario::ActiveEffect>();
  return std::make_unique<VirtualCamera>(scenario.WithCamera(number), robot_surface, acting,
                                         seed + number * kApart);
}

std::vector<std::unique_ptr<VirtualCamera>> MakeCameras(
    const scenario::Scenario& scenario, const RobotSurface& robot_surface,
    const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed) {
  std::vector<std::unique_ptr<VirtualCamera>> cameras;
  for (std::size_t k = 0; k <= scenario.further_cameras.size(); ++k) {
    cameras.push_back(MakeCamera(scenario, k, robot_surface, effects, seed));
  }
  return cameras;
}

}  // namespace palpate::virtual_camera
