// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/scenario/effect.hpp"

namespace palpate::scenario {

namespace {

constexpr double kOfTheRobotFile = std::numeric_limits<double>::quiet_NaN();
/// Points and lengths in a scenario lie within so many metres.
constexpr double kFar_m = 5.0;

EffectParameter Coordinate(std::string_view name) {
  return {.name = name, .min = -kFar_m, .max = kFar_m};
}

EffectParameter Component(std::string_view name, double largest, double tolerance = 0.0) {
  return {.name = name, .tolerance = tolerance, .min = -largest, .max = largest, .required = false};
}

std::vector<EffectKind> MaterialEffects() {
  using enum Place;
  const Side body = Side::kBody;
  return {
      {"youngs_modulus",
       body,
       kBody,
       {{"factor", 1.0, 0.03, 0.05, 20.0}},
       "Young's modulus of the whole body is factor times the nominal one"},
      {"regional_stiffness",
       body,
       kRegion,
       {{"factor", 1.0, 0.03, 0.05, 20.0}},
       "Young's modulus of a region of the robot file is factor times the nominal one"},
      {"poissons_ratio",
       body,
       kBody,
       {{"nu", kOfTheRobotFile, 0.005, 0.0, 0.4999}},
       "Poisson's ratio of the whole body is nu"},
      {"stiffening",
       body,
       kBody,
       {{"C2_over_C1", 0.0, 0.0, 0.0, 10.0}},
       "the material stiffens with strain as Yeoh's with C20 = C2_over_C1 C10"},
      {"density",
       body,
       kBody,
       {{"factor", 1.0, 0.01, 0.1, 10.0}},
       "the body's density is factor times the nominal one"},
      {"viscoelastic_creep",
       body,
       kBody,
       {{"g", 0.0, 0.02, 0.0, 5.0}, {"tau_s", 10.0, 0.0, 1e-3, 1e5}},
       "one more Prony term: the instantaneous modulus is (1 + g) times the long-term one"},
      {"mullins",
       body,
       kBody,
       {{"r", 1e6, 0.0, 1.0, 1e6}, {"m", 1e3, 0.0, 1e-3, 1e6}},
       "Ogden-Roxburgh softening 1 - erf((W_max - W) / m) / r of a body strained before, m in "
       "J/m3"},
  };
}

std::vector<EffectKind> ShapeEffects() {
  using enum Place;
  const Side body = Side::kBody;
  return {
      {"plastic_set",
       body,
       kBody,
       {{"tip_m", 0.0, 2e-4, -0.05, 0.05}},
       "the rest shape is bent; the point that moves most (the tip) moves by tip_m, in a direction "
       "drawn by the seed"},
      {"geometry_scale",
       body,
       kBody,
       {{"factor", 1.0, 0.005, 0.8, 1.25}},
       "the body is factor times as large; pull points stay on the ground"},
      {"temperature",
       body,
       kBody,
       {{"relative_E_change_at_end", 0.0, 0.0, -0.5, 1.0}},
       "the modulus changes linearly in time, to (1 + this) times the nominal one at the end of "
       "the "
       "experiment"},
      {"rest_twist",
       body,
       kBody,
       {{"rate_rad_m", 0.0, 0.0, -20.0, 20.0}},
       "the rest shape is twisted about its long axis, starting at the fixed end"},
  };
}

std::vector<EffectKind> BaseEffects() {
  using enum Place;
  const Side base = Side::kBase;
  return {
      {"base_compliance",
       base,
       kBase,
       {{"compliance_rad_Nm", 0.0, 0.0, 0.0, 100.0}},
       "the base turns by this per N m of moment"},
      {"gravity_direction",
       base,
       kBase,
       {Component("theta_x_deg", 30.0, 0.3), Component("theta_y_deg", 30.0, 0.3)},
       "the base is tilted by R = Ry(theta_y) Rx(theta_x), in addition to base_tilt_deg"},
      {"payload",
       Side::kBody,
       kBody,
       {{"mass_kg", 0.0, 0.0, 0.0, 1.0}, Coordinate("x_m"), Coordinate("y_m"), Coordinate("z_m")},
       "an undeclared mass at this point of the undeformed body"},
      {"permanent_force",
       Side::kBody,
       kBody,
       {Component("fx_N", 20.0), Component("fy_N", 20.0), Component("fz_N", 20.0),
        Coordinate("x_m"), Coordinate("y_m"), Coordinate("z_m")},
       "a constant force in the world frame at this point of the undeformed body"},
      {"hidden_obstacle",
       Side::kBody,
       kBody,
       {{"gap_m", 0.0, 0.0, 0.0, 0.5},
        {"nx", 0.0, 0.0, -1.0, 1.0},
        {"ny", 0.0, 0.0, -1.0, 1.0},
        {"nz", 0.0, 0.0, -1.0, 1.0}},
       "a rigid half-space; its normal n = (nx, ny, nz) points to the body, gap_m is the distance "
       "of "
       "the undeformed body"},
  };
}

std::vector<EffectKind> CableEffects() {
  using enum Place;
  const Side drive = Side::kActuator;
  return {
      {"cable_friction",
       drive,
       kCable,
       {{"mu", 0.0, 0.02, 0.0, 2.0}},
       "capstan friction in the eyelets, with sticking, in both directions"},
      {"cable_elasticity",
       drive,
       kCable,
       {{"k_N_m", 1e9, 0.0, 10.0, 1e9}},
       "the cable is a spring of this stiffness"},
      {"cable_cutting",
       drive,
       kCable,
       {{"compliance_m_N", 0.0, 0.0, 0.0, 0.1}},
       "compliance of the eyelets: displacement per N of tension"},
      {"cable_gain",
       drive,
       kCable,
       {{"g", 0.0, 0.005, -0.5, 0.5}},
       "the actuator pulls (1 + g) times the commanded displacement"},
      {"cable_offset",
       drive,
       kCable,
       {{"offset_m", 0.0, 3e-4, -0.05, 0.05}},
       "the actuator pulls this much more than commanded; negative: slack"},
      {"backlash",
       drive,
       kCable,
       {{"play_m", 0.0, 1e-4, 0.0, 0.05}},
       "play of this full width between actuator and cable"},
      {"cable_routing",
       drive,
       kCable,
       {Component("dy_m", 0.02, 3e-4), Component("dz_m", 0.02, 3e-4)},
       "the point that the cable is pulled from is displaced by (0, dy, dz), robot frame"},
      {"swapped_cables", drive, kTwoCables, {}, "two cables are exchanged"},
      {"drive_coupling",
       drive,
       kTwoCables,
       {{"coupling", 0.0, 0.0, -1.0, 1.0}},
       "the first cable moves by this share of the second cable's command"},
      {"lag",
       drive,
       kBody,
       {{.name = "delay_s", .tolerance = 0.01, .max = 5.0, .required = false},
        {.name = "tau_s", .max = 5.0, .required = false}},
       "all actuators follow their commands with a dead time and a first-order lag"},
  };
}

/// Of the supply of a chamber in this order (components/virtual_robot/pressure_supply.hpp), and of
/// its wall.
std::vector<EffectKind> ChamberEffects() {
  using enum Place;
  const Side drive = Side::kActuator;
  return {
      {"swapped_tubes", drive, kTwoChambers, {}, "the tubes of two chambers are exchanged"},
      {"pressure_gain",
       drive,
       kChamber,
       {{"g", 0.0, 0.01, -0.5, 0.5}},
       "the supply has (1 + g) times the pressure that its sensor reads"},
      {"pressure_zero",
       drive,
       kChamber,
       {{"zero_Pa", 0.0, 100.0, -50e3, 50e3}},
       "the supply has this pressure where its sensor reads zero"},
      {"slow_valve",
       drive,
       kChamber,
       {{"tau_s", 0.0, 0.01, 0.0, 100.0}},
       "the valve's time constant is longer by this"},
      {"leak",
       drive,
       kChamber,
       {{"ratio", 0.0, 0.0, 0.0, 10.0}},
       "the chamber leaks; conductance of the leak over that of the valve"},
      {"blocked_valve",
       drive,
       kChamber,
       {{.name = "from_recording", .max = 1e6, .whole = true}},
       "from this recording on (the first is 0) the chamber keeps its pressure"},
      {"thin_wall",
       Side::kBody,
       kChamber,
       {{"thinner_m", 0.0, 1e-4, -0.005, 0.005}},
       "the wall of the chamber is thinner than drawn by this, at the side of the chamber"},
  };
}

std::vector<EffectKind> CameraEffects() {
  using enum Place;
  const Side camera = Side::kCamera;
  return {
      {"camera_moved",
       camera,
       kCamera,
       {{.name = "translation_m", .max = 0.5, .required = false},
        {.name = "rotation_rad", .max = 1.0, .required = false},
        {.name = "from_recording", .max = 1e6, .whole = true}},
       "the camera pose changes from this recording on (the first is 0), in directions drawn by "
       "the "
       "seed"},
      {"depth_scale",
       camera,
       kCamera,
       {{"s", 0.0, 0.002, -0.2, 0.2}},
       "depth is 1 + s times the true one"},
      {"depth_incidence_bias",
       camera,
       kCamera,
       {{"b_m", 0.0, 0.0, -0.05, 0.05}},
       "depth of a surface seen at the angle a to its normal is too large by b (1 / cos a - 1), "
       "with "
       "cos a at least 0.25"},
      {"intrinsics",
       camera,
       kCamera,
       {Component("focal", 0.1, 0.002), Component("cx_px", 50.0, 1.0),
        Component("cy_px", 50.0, 1.0)},
       "the focal length of the depth camera is (1 + focal) times that of camera.yaml; the "
       "principal "
       "point is off by (cx, cy)"},
      {"lens_distortion",
       camera,
       kCamera,
       {{"k1", 0.0, 0.0, -0.3, 0.3}},
       "k1 of the lens exceeds that of camera.yaml by this"},
      {"flying_pixels",
       camera,
       kCamera,
       {{"ratio", 0.0, 0.0, 0.0, 1.0}},
       "additional share of pixels along depth edges that lie between front and back"},
      {"warm_up_drift",
       camera,
       kCamera,
       {{"amplitude_m", 0.0, 0.0, -0.05, 0.05}, {"tau_s", 600.0, 0.0, 1.0, 1e5}},
       "depth is off by amplitude (1 - exp(-t / tau)), t since the camera was switched on"},
      {"marker_misplacement",
       Side::kBody,
       kMarker,
       {{"d_m", 0.0, 1e-3, 0.0, 0.1}},
       "distance of the marker from its place in the robot file, in a direction drawn by the seed"},
  };
}

std::vector<EffectKind> MakeCatalogue() {
  std::vector<EffectKind> catalogue = MaterialEffects();
  for (const auto& more :
       {ShapeEffects(), BaseEffects(), CableEffects(), ChamberEffects(), CameraEffects()}) {
    catalogue.insert(catalogue.end(), more.begin(), more.end());
  }
  return catalogue;
}

}  // namespace

const std::vector<EffectKind>& EffectCatalogue() {
  static const std::vector<EffectKind> catalogue = MakeCatalogue();
  return catalogue;
}

const EffectKind* FindEffect(std::string_view id) {
  const auto& catalogue = EffectCatalogue();
  const auto found = std::find_if(catalogue.begin(), catalogue.end(),
                                  [&](const EffectKind& kind) { return kind.id == id; });
  return found == catalogue.end() ? nullptr : &*found;
}

double ActiveEffect::Get(std::string_view parameter) const {
  const auto found = parameters.find(std::string(parameter));
  PALPATE_CHECK(found != parameters.end(), id, "has no parameter", parameter);
  return found->second;
}

}  // namespace palpate::scenario
