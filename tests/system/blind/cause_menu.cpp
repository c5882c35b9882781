// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/cause_menu.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::blind {

namespace {

using robot::RobotDescription;
using scenario::Random;

double Logarithmic(Random* random, double low, double high) {
  return low * std::pow(high / low, random->Uniform());
}

/// Either sign.
double Signed(Random* random, double low, double high) {
  const double size = Logarithmic(random, low, high);
  return random->Below(2) == 0 ? size : -size;
}

/// 1 + change, or its reciprocal.
double Factor(Random* random, double low, double high) {
  const double factor = 1.0 + Logarithmic(random, low, high);
  return random->Below(2) == 0 ? factor : 1.0 / factor;
}

/// Of this length, in any direction.
Eigen::Vector2d InPlane(Random* random, double low, double high) {
  const double length = Logarithmic(random, low, high);
  const double angle_rad = 2.0 * std::numbers::pi * random->Uniform();
  return length * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

/// About a marker, within 5 mm of it: the places that markers sit at are no better known to whoever
/// looks for the load than others.
Parameters WithPlace(Random* random, const RobotDescription& robot, Parameters parameters) {
  constexpr double kAbout_m = 0.005;
  const Eigen::Vector3d marker_m = robot.markers[random->Below(robot.markers.size())].position_m;
  const Eigen::Vector3d place_m = marker_m + kAbout_m * random->Uniform() * random->Direction();
  parameters.insert({{"x_m", place_m.x()}, {"y_m", place_m.y()}, {"z_m", place_m.z()}});
  return parameters;
}

Parameters DrawForce(Random* random, const RobotDescription& robot) {
  const double size_N = Logarithmic(random, 0.06, 0.3);
  const Eigen::Vector3d force_N = size_N * random->Direction();
  return WithPlace(random, robot,
                   {{"fx_N", force_N.x()}, {"fy_N", force_N.y()}, {"fz_N", force_N.z()}});
}

/// Beside and above a leg's back, where it goes when its own cable is pulled: nothing of the body
/// comes near a wall elsewhere.
Parameters DrawObstacle(Random* random, const RobotDescription& robot) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const Eigen::Vector3d pull_m = robot.cables[random->Below(robot.cables.size())].path_m.col(0);
  const double heading_rad =
      std::atan2(pull_m.y(), pull_m.x()) + kDegree * (30.0 * random->Uniform() - 15.0);
  const double polar_rad = kDegree * (48.0 + 10.0 * random->Uniform());
  return {{"gap_m", Logarithmic(random, 3e-4, 2e-3)},
          {"nx", -std::sin(polar_rad) * std::cos(heading_rad)},
          {"ny", -std::sin(polar_rad) * std::sin(heading_rad)},
          {"nz", -std::cos(polar_rad)}};
}

std::vector<MenuItem> BodyCauses() {
  using R = const RobotDescription&;
  return {
      {"youngs_modulus",
       [](Random* r, R) -> Parameters {
         return {{"factor", Factor(r, 0.3, 1)}};
       }},
      {"regional_stiffness",
       [](Random* r, R) -> Parameters {
         return {{"factor", Factor(r, 0.2, 0.5)}};
       }},
      {"stiffening",
       [](Random* r, R) -> Parameters {
         return {{"C2_over_C1", Logarithmic(r, 6, 10)}};
       }},
      {"density",
       [](Random* r, R) -> Parameters {
         return {{"factor", Factor(r, 0.07, 0.3)}};
       }},
      {"viscoelastic_creep",
       [](Random* r, R) -> Parameters {
         return {{"g", Logarithmic(r, 0.1, 0.4)}, {"tau_s", Logarithmic(r, 1, 100)}};
       }},
      {"mullins",
       [](Random* r, R) -> Parameters {
         return {{"r", Logarithmic(r, 2, 4)}, {"m", Logarithmic(r, 200, 1000)}};
       }},
      {"plastic_set",
       [](Random* r, R) -> Parameters {
         return {{"tip_m", Signed(r, 8e-4, 4e-3)}};
       }},
      {"geometry_scale",
       [](Random* r, R) -> Parameters {
         return {{"factor", Factor(r, 0.015, 0.03)}};
       }},
      {"temperature",
       [](Random* r, R) -> Parameters {
         return {{"relative_E_change_at_end", Signed(r, 0.07, 0.3)}};
       }},
      {"rest_twist",
       [](Random* r, R) -> Parameters {
         return {{"rate_rad_m", Signed(r, 0.12, 1)}};
       }},
      {"gravity_direction",
       [](Random* r, R) -> Parameters {
         const Eigen::Vector2d tilt_deg = InPlane(r, 1.2, 5);
         return {{"theta_x_deg", tilt_deg.x()}, {"theta_y_deg", tilt_deg.y()}};
       }},
      {"payload",
       [](Random* r, R robot) -> Parameters {
         return WithPlace(r, robot, {{"mass_kg", Logarithmic(r, 0.012, 0.05)}});
       }},
      {"permanent_force", DrawForce},
      {"hidden_obstacle", DrawObstacle},
      {"marker_misplacement",
       [](Random* r, R) -> Parameters {
         return {{"d_m", Logarithmic(r, 3e-3, 0.015)}};
       }},
  };
}

std::vector<MenuItem> CableCauses() {
  using R = const RobotDescription&;
  return {
      {"cable_elasticity",
       [](Random* r, R) -> Parameters {
         return {{"k_N_m", Logarithmic(r, 500, 1500)}};
       }},
      {"cable_gain",
       [](Random* r, R) -> Parameters {
         return {{"g", Signed(r, 0.085, 0.1)}};
       }},
      {"cable_offset",
       [](Random* r, R) -> Parameters {
         return {{"offset_m", Signed(r, 1.2e-3, 5e-3)}};
       }},
      {"backlash",
       [](Random* r, R) -> Parameters {
         return {{"play_m", Logarithmic(r, 2e-3, 6e-3)}};
       }},
      {"cable_routing",
       [](Random* r, R) -> Parameters {
         const Eigen::Vector2d moved_m = InPlane(r, 2e-3, 5e-3);
         return {{"dy_m", moved_m.x()}, {"dz_m", moved_m.y()}};
       }},
      {"swapped_cables", [](Random*, R) -> Parameters { return {}; }},
      // Up to 10 % of a command moves the markers by 0.2 mm here: mostly it tightens slack cables.
      {"drive_coupling",
       [](Random* r, R) -> Parameters {
         return {{"coupling", Signed(r, 0.15, 0.3)}};
       }},
      {"lag",
       [](Random* r, R) -> Parameters {
         const double late_s = Logarithmic(r, 0.06, 0.3);
         return {{r->Below(2) == 0 ? "delay_s" : "tau_s", late_s}};
       }},
  };
}

/// Of a path of two points one is on the ground and one is a knot.
bool HasEyelets(const RobotDescription& robot) {
  return std::any_of(robot.cables.begin(), robot.cables.end(),
                     [](const robot::CableSettings& cable) { return cable.path_m.cols() > 2; });
}

/// Of the largest pressure that a chamber may have.
double LeastOfLimits_Pa(const RobotDescription& robot) {
  double least_Pa = robot.chambers.front().max_pressure_Pa;
  for (const robot::ChamberSettings& chamber : robot.chambers)
    least_Pa = std::min(least_Pa, chamber.max_pressure_Pa);
  return least_Pa;
}

}  // namespace

const std::vector<MenuItem>& ChamberMenu() {
  using R = const RobotDescription&;
  static const std::vector<MenuItem> menu = {
      {"leak",
       [](Random* r, R) -> Parameters {
         return {{"ratio", Logarithmic(r, 0.4, 1.0)}};
       }},
      {"slow_valve",
       [](Random* r, R) -> Parameters {
         return {{"tau_s", Logarithmic(r, 0.1, 1.0)}};
       }},
      // Of the recordings between the first and the last one.
      {"blocked_valve",
       [](Random* r, R robot) -> Parameters {
         const std::size_t most = 4 + robot.chambers.size();
         return {{"from_recording", static_cast<double>(1 + r->Below(most))}};
       }},
      {"pressure_gain",
       [](Random* r, R) -> Parameters {
         return {{"g", Signed(r, 0.3, 0.5)}};
       }},
      {"pressure_zero",
       [](Random* r, R robot) -> Parameters {
         const double limit_Pa = LeastOfLimits_Pa(robot);
         return {{"zero_Pa", Signed(r, 0.06 * limit_Pa, 0.12 * limit_Pa)}};
       }},
      {"swapped_tubes", [](Random*, R) -> Parameters { return {}; }},
      {"thin_wall",
       [](Random* r, R) -> Parameters {
         return {{"thinner_m", Logarithmic(r, 7e-4, 1.2e-3)}};
       }},
  };
  return menu;
}

const std::vector<MenuItem>& EyeletMenu() {
  static const std::vector<MenuItem> menu = [] {
    std::vector<MenuItem> all = CauseMenu();
    // Where the body goes depends on more than the ground points of its cables.
    std::erase_if(all, [](const MenuItem& item) { return item.id == "hidden_obstacle"; });
    all.push_back({"cable_friction", [](Random* r, const RobotDescription&) -> Parameters {
                     return {{"mu", Logarithmic(r, 0.1, 0.4)}};
                   }});
    return all;
  }();
  return menu;
}

std::vector<MenuItem> MenuFor(const RobotDescription& robot) {
  if (robot.chambers.empty()) return HasEyelets(robot) ? EyeletMenu() : CauseMenu();
  std::vector<MenuItem> menu = ChamberMenu();
  if (robot.chambers.size() < 2)
    std::erase_if(menu, [](const MenuItem& item) { return item.id == "swapped_tubes"; });
  return menu;
}

const std::vector<MenuItem>& CauseMenu() {
  static const std::vector<MenuItem> menu = [] {
    std::vector<MenuItem> all = BodyCauses();
    for (const MenuItem& item : CableCauses()) all.push_back(item);
    return all;
  }();
  return menu;
}

const std::vector<LeftOut>& LeftOutOfMenu() {
  static const std::vector<LeftOut> left_out = [] {
    std::vector<LeftOut> all = {
        {"poissons_ratio", "0.49 in place of 0.45 moves no marker by more than 0.2 mm RMS"},
        {"base_compliance", "the virtual robot finds no equilibrium of four_leg with it"},
        {"cable_friction", "its cables end in knots: there is no eyelet to rub in"},
        {"cable_cutting", "at a knot it is cable_elasticity of the inverse stiffness"},
    };
    for (const MenuItem& item : ChamberMenu()) all.push_back({item.id, "it has no chambers"});
    for (const std::string_view camera :
         {"camera_moved", "depth_scale", "depth_incidence_bias", "intrinsics", "lens_distortion",
          "flying_pixels", "warm_up_drift"}) {
      all.push_back({camera, "no camera looks: markers are measured in the robot's frame"});
    }
    return all;
  }();
  return left_out;
}

std::vector<std::string> TwinsOf(const scenario::ActiveEffect& effect) {
  if (effect.id == "cable_elasticity") return {"cable_cutting"};
  // A leak takes a share of every pressure, as a sensor that reads too much does.
  if (effect.id == "leak") return {"pressure_gain"};
  if (effect.id == "pressure_gain" && effect.parameters.at("g") < 0.0) return {"leak"};
  return {};
}

std::vector<std::string> CoveredBy(const scenario::ActiveEffect& effect) {
  if (effect.id == "payload") return {"permanent_force"};  // downwards, however the base is tilted
  return TwinsOf(effect);
}

}  // namespace palpate::blind
