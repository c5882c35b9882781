// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/joint_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/joint/models_like.hpp"
#include "components/calibration/joint/pressure_unknowns.hpp"
#include "components/calibration/joint/route_unknowns.hpp"
#include "components/calibration/size_comparison.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/core/thread_team.hpp"
#include "libs/geometry/rigid_registration.hpp"
#include "libs/robot/calibrated_geometry.hpp"

namespace palpate::calibration {

namespace {

using Kind = robot::ActuatorCommand::Kind;

struct JointRequestTuning {
  /// Residual over the markers' spread of another robot: less refuses poor models of this one.
  double wrong_robot_share = 0.1;
  /// Residual over that of a reflection up to which the undeformed body gives the initial pose:
  /// more saves equilibria, and risks a mirrored start.
  double clearly_not_mirrored = 0.5;
  double first_tension_N = 0.5;  ///< initial value of an unknown tension: taut, and far from limits
  double least_gain = -0.9;      ///< of a pressure sensor: above -1, where it reads nothing
  double least_poissons_ratio = 0.0;
  double most_poissons_ratio = 0.4999;  ///< below 0.5, where the volume is fixed
};
constexpr JointRequestTuning kRequestTuning;

/// The frames' equilibria under the prior means of their inputs.
Status SolveStates(robot::RobotModel& model, JointSetup* setup) {
  std::vector<robot::RobotModel*> models = {&model};
  for (const auto& helper : setup->helpers) models.push_back(helper.get());
  const Eigen::Vector3d gravity_m_s2 = model.gravity_m_s2();
  setup->states.assign(setup->frames.size(), model.RestState());
  std::vector<Status> status(setup->frames.size(), Status::Ok());
  ThreadTeam team(static_cast<int>(models.size()));
  team.Run([&](int index) {
    const auto first = static_cast<std::size_t>(index);
    for (std::size_t f = first; f < status.size(); f += models.size()) {
      const CalibrationFrame& frame = setup->frames[f];
      models[first]->SetGravity(frame.gravity_m_s2);
      status[f] = models[first]->Solve(frame.cables, frame.loads, &setup->states[f]).status;
    }
  });
  model.SetGravity(gravity_m_s2);
  for (std::size_t f = 0; f < status.size(); ++f) {
    if (status[f].ok()) continue;
    return {status[f].code(), setup->frames[f].name + ": " + status[f].message()};
  }
  return Status::Ok();
}

/// Registration of the markers of all frames with the model's in these shapes [frames] of [3n].
geometry::Registration Register(const robot::RobotModel& model, const JointSetup& setup,
                                const std::vector<Eigen::VectorXd>& x_m) {
  std::vector<Eigen::Vector3d> seen, expected;
  for (std::size_t f = 0; f < setup.frames.size(); ++f) {
    if (setup.frames[f].own_pose >= 0) continue;
    for (const MarkerSighting& sighting : setup.frames[f].markers) {
      const auto& marker = model.body().markers.at(At(sighting.marker));
      seen.push_back(sighting.position_m);
      expected.push_back(marker.point.weights.Position(x_m[f]));
    }
  }
  const auto count = ToIndex(seen.size());
  Eigen::Matrix3Xd source_m(3, count), target_m(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    source_m.col(k) = seen[At(k)];
    target_m.col(k) = expected[At(k)];
  }
  return geometry::RegisterRigid(source_m, target_m);
}

/// Initial camera pose by registration with the undeformed body, or with the frames' equilibria
/// where a mirror image fits nearly as well.
Status FindModelStart(robot::RobotModel& model, JointSetup* setup) {
  const std::vector<Eigen::VectorXd> at_rest(setup->frames.size(), model.RestState().x_m);
  geometry::Registration registration = Register(model, *setup, at_rest);
  if (!registration.status.ok() ||
      registration.rms_m > kRequestTuning.clearly_not_mirrored * registration.mirrored_rms_m) {
    if (Status status = SolveStates(model, setup); !status.ok()) return status;
    std::vector<Eigen::VectorXd> solved;
    for (const fem::StaticState& state : setup->states) solved.push_back(state.x_m);
    registration = Register(model, *setup, solved);
  }
  setup->T_robot_camera = registration.T_target_source;
  if (registration.status.ok() || !setup->pose_prior) return registration.status;
  setup->T_robot_camera = setup->pose_prior->T_robot_camera;
  return Status::Ok();
}

/// An unknown tension for each cable without an input in a frame. A chamber without one is open to
/// the air.
void AddInputs(const robot::RobotModel& model, JointSetup* setup) {
  for (std::size_t f = 0; f < setup->frames.size(); ++f) {
    for (int c = 0; c < model.CableCount(); ++c) {
      const auto cable = static_cast<size_t>(c);
      robot::ActuatorCommand& command = setup->frames[f].cables[cable];
      if (command.kind != Kind::kNone) continue;
      command = {Kind::kTension, kRequestTuning.first_tension_N};
      setup->unknowns.push_back(CableInput(static_cast<int>(f), setup->frames[f].name, c,
                                           model.traits(c).name, Kind::kTension,
                                           {.mean = kRequestTuning.first_tension_N,
                                            .lower = 0.0,
                                            .upper = model.traits(c).most_force_N,
                                            .plausible = 1.0}));
    }
  }
}

void AddActuators(const robot::RobotModel& model, const JointRequest& request, JointSetup* setup) {
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const auto cable = static_cast<size_t>(c);
    const std::string& name = model.traits(c).name;
    std::vector<double> measured;
    bool driven = false;
    for (const CalibrationFrame& frame : setup->frames) {
      const bool by_displacement = frame.cables[cable].kind == Kind::kDisplacement;
      driven = driven || by_displacement;
      measured.push_back(by_displacement ? frame.cables[cable].value : 0.0);
    }
    if (!driven) continue;
    if (request.actuator_offsets) {
      const double sigma_m = request.actuator_offset_sigma_m;
      setup->unknowns.push_back(CommandOffset(c, name, {.sigma = sigma_m, .plausible = sigma_m}));
    }
    if (request.actuator_gains) {
      const double sigma = request.actuator_gain_sigma;
      setup->unknowns.push_back(
          CommandGain(c, name, std::move(measured), {.sigma = sigma, .plausible = sigma}));
    }
  }
}

/// Which of both the gain of a pressure sensor lacks: without a known force a softer body and a
/// larger pressure are one.
std::string WhatTellsGain(const JointRequest& request) {
  return request.moduli.empty()
             ? "recordings with markers or images of the part that this chamber moves, at larger "
               "pressures"
             : "a recording with a known load, or a calibration with --what camera and a modulus "
               "that is known: without one of both, gain and Young's modulus have the same effect";
}

/// Of chambers whose pressure is read in a frame.
void AddPressureSensors(const robot::RobotModel& model, const JointRequest& request,
                        JointSetup* setup) {
  for (int c = model.CableCount(); c < model.ActuatorCount(); ++c) {
    const robot::ActuatorTraits& chamber = model.traits(c);
    std::vector<double> read_N;
    bool is_read = false;
    for (const CalibrationFrame& frame : setup->frames) {
      const robot::ActuatorCommand& command = frame.cables[At(c)];
      const bool by_pressure = command.kind == Kind::kTension;
      is_read = is_read || by_pressure;
      read_N.push_back(by_pressure ? command.value : 0.0);
    }
    if (!is_read) continue;
    if (const double sigma_Pa = request.pressure_zero_sigma_Pa; sigma_Pa > 0.0) {
      setup->unknowns.push_back(PressureZero(c, chamber.name, chamber.area_m2,
                                             {.sigma = sigma_Pa, .plausible = sigma_Pa}));
    }
    if (const double sigma = request.pressure_gain_sigma; sigma > 0.0) {
      setup->unknowns.push_back(
          PressureGain(c, chamber.name, std::move(read_N),
                       {.sigma = sigma, .lower = kRequestTuning.least_gain, .plausible = sigma},
                       WhatTellsGain(request)));
    }
  }
}

void AddModuli(const robot::RobotModel& model, const JointRequest& request, JointSetup* setup) {
  for (const int material : request.moduli) {
    const auto index = static_cast<size_t>(material);
    const std::string part = material == 0 ? "body" : model.body().region_names.at(index - 1);
    const double sigma = request.modulus_relative_sigma;
    setup->unknowns.push_back(LogYoungsModulus(material, part,
                                               model.body().materials.at(index).youngs_modulus_Pa,
                                               {.sigma = sigma, .plausible = sigma}));
  }
}

void AddPoissonsRatios(const robot::RobotModel& model, const JointRequest& request,
                       JointSetup* setup) {
  const double sigma = request.poissons_ratio_sigma;
  if (sigma <= 0.0) return;
  for (const int material : request.moduli) {
    const auto index = static_cast<size_t>(material);
    const std::string part = material == 0 ? "body" : model.body().region_names.at(index - 1);
    setup->unknowns.push_back(
        PoissonsRatioOf(material, part,
                        {.mean = model.body().materials.at(index).poissons_ratio,
                         .sigma = sigma,
                         .lower = kRequestTuning.least_poissons_ratio,
                         .upper = kRequestTuning.most_poissons_ratio,
                         .plausible = sigma}));
  }
}

/// Tilts of gravity, and a factor on it.
void AddWeight(const robot::RobotModel& model, const JointRequest& request, JointSetup* setup) {
  const double tilt_sigma = std::tan(request.gravity_tilt_sigma_rad);
  if (tilt_sigma > 0.0) {
    for (const TiltAxis& axis : TiltAxes(model.gravity_m_s2())) {
      setup->unknowns.push_back(
          GravityTilt(axis.name, axis.direction, {.sigma = tilt_sigma, .plausible = tilt_sigma}));
    }
  }
  const double mass_sigma = request.mass_relative_sigma;
  if (mass_sigma > 0.0) {
    setup->unknowns.push_back(
        MassFactor({.mean = 1.0, .sigma = mass_sigma, .lower = 0.0, .plausible = mass_sigma}));
  }
}

/// Points of a cable's route.
void AddRoute(const robot::RobotBody& body, const JointRequest& request, int cable,
              JointSetup* setup) {
  const auto points = 1 + body.cables[At(cable)].eyelets.size();
  for (int point = 0; point < static_cast<int>(points); ++point) {
    const double sigma_m = point == 0 ? request.cable_route_sigma_m : request.cable_eyelet_sigma_m;
    if (sigma_m <= 0.0) continue;
    GaussianPrior prior{.sigma = sigma_m, .plausible = sigma_m};
    if (point > 0) {
      prior.upper = std::sqrt(0.5) * body.eyelet_room_m;  // both directions at once
      prior.lower = -prior.upper;
    }
    for (const TiltAxis& direction : AcrossCable(body, cable, point)) {
      setup->unknowns.push_back(RouteOf(body, cable, point, direction, prior));
    }
  }
}

/// Size of the robot, and its cable routes.
void AddGeometry(const robot::RobotModel& model, const JointRequest& request, JointSetup* setup) {
  const double scale_sigma = request.geometry_scale_sigma;
  if (scale_sigma > 0.0) {
    setup->unknowns.push_back(GeometryScaleOf({.mean = 1.0,
                                               .sigma = scale_sigma,
                                               .lower = robot::kSmallestScale,
                                               .upper = robot::kLargestScale,
                                               .plausible = scale_sigma}));
  }
  for (int c = 0; c < model.CableCount(); ++c) {
    AddRoute(model.body(), request, c, setup);
  }
}

std::string Millimetres(double length_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f mm", 1e3 * length_m);
  return text.data();
}

/// Measured markers against the model's in the estimated shapes.
SizeComparison CompareSizes(const robot::RobotModel& model,
                            const std::vector<CalibrationFrame>& frames,
                            const std::vector<Eigen::VectorXd>& x_m) {
  SizeComparison sizes;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::vector<MarkerSighting>& seen = frames[f].markers;
    Eigen::Matrix3Xd model_m(3, ToIndex(seen.size()));
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const auto& marker = model.body().markers.at(At(seen[k].marker));
      model_m.col(ToIndex(k)) = marker.point.weights.Position(x_m[f]);
    }
    sizes.Add(PositionsOf(seen), model_m);
  }
  return sizes;
}

}  // namespace

Status MakeJointSetup(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                      const geometry::RigidTransform* T_robot_camera, const JointRequest& request,
                      JointSetup* setup) {
  setup->frames = std::move(frames);
  setup->fit_pose = request.pose;
  setup->pose_prior = request.pose_prior;
  setup->own_poses = request.own_poses;
  setup->estimate_marker_offsets = request.marker_offset_sigma_m > 0.0;
  setup->marker_offset_sigma_m = setup->estimate_marker_offsets ? request.marker_offset_sigma_m
                                                                : request.marker_placement_sigma_m;
  if (request.cable_eyelet_sigma_m > model.body().eyelet_room_m) {
    return {StatusCode::kInvalidInput, "the model has no room to move eyelets by " +
                                           FormatNumber(request.cable_eyelet_sigma_m) +
                                           " m: build its body with eyelet room"};
  }
  if (request.geometry_scale_sigma > 0.0 && model.ChamberCount() > 0) {
    return {StatusCode::kInvalidInput,
            "the size of a robot with chambers is not estimated: leave its prior out"};
  }
  AddInputs(model, setup);
  const int threads = std::min(request.threads, static_cast<int>(setup->frames.size()));
  setup->helpers = ModelsLike(model, std::max(0, threads - 1));
  if (T_robot_camera != nullptr) {
    setup->T_robot_camera = *T_robot_camera;
  } else if (request.pose) {
    if (Status status = FindModelStart(model, setup); !status.ok()) return status;
  }
  AddActuators(model, request, setup);
  AddPressureSensors(model, request, setup);
  AddModuli(model, request, setup);
  AddPoissonsRatios(model, request, setup);
  AddWeight(model, request, setup);
  AddGeometry(model, request, setup);
  if (request.depth_scale_sigma > 0.0) {
    const double sigma = request.depth_scale_sigma;
    setup->depth_bias =
        DepthBiasPrior{.coefficient = {.sigma = sigma, .plausible = sigma}, .basis = {.order = 0}};
  } else if (request.depth_bias_sigma > 0.0) {
    const double sigma = request.depth_bias_sigma;
    setup->depth_bias =
        DepthBiasPrior{.coefficient = {.sigma = sigma, .plausible = sigma}, .estimated = false};
  }
  return Status::Ok();
}

JointCalibration CalibrateFrames(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                                 const geometry::RigidTransform* T_robot_camera,
                                 const JointRequest& request) {
  const ModelSnapshot kept(model);
  JointSetup setup;
  JointCalibration result;
  result.status = MakeJointSetup(model, std::move(frames), T_robot_camera, request, &setup);
  if (!result.status.ok()) return result;
  JointSettings settings;
  settings.solver.huber_threshold = request.huber_threshold;
  settings.solver.stop = request.stop;
  settings.solver.iterations = request.iterations;
  result = CalibrateJointly(model, setup, settings);
  if (!result.status.ok()) return result;
  const SizeComparison sizes = CompareSizes(model, setup.frames, result.x_m);
  if (result.residual_rms_m > kRequestTuning.wrong_robot_share * sizes.seen_m()) {
    kept.Restore();
    const std::string off =
        "the markers are " + Millimetres(result.residual_rms_m) + " from the model's (RMS)";
    result.status = Status(StatusCode::kInvalidInput,
                           sizes.Explains(result.residual_rms_m)
                               ? off + "; " + sizes.Text()
                               : off + ", with a spread of " + Millimetres(sizes.seen_m()) +
                                     ": another robot, or other markers");
  }
  return result;
}

}  // namespace palpate::calibration
