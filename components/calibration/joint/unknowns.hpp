// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "components/calibration/joint/unknown.hpp"

/// The unknowns there are, one function each, but for those of cables' paths (route_unknowns.hpp).
/// `mean` of a belief is the value to start from; the model and frames hold everything else.
namespace palpate::calibration {

/// Displacement (m) or tension (N) of a cable in one frame, in place of the frame's command;
/// `frame_name` and `cable_name` are for the name.
UnknownPtr CableInput(int frame, const std::string& frame_name, int cable,
                      const std::string& cable_name, robot::CableCommand::Kind kind,
                      const Belief& belief);

/// o, m: displacements u that this cable is commanded in any frame are (1 + g) u + o.
UnknownPtr CommandOffset(int cable, const std::string& cable_name, const Belief& belief);
/// g; `measured` are the displacements u, one for each frame.
UnknownPtr CommandGain(int cable, const std::string& cable_name, std::vector<double> measured,
                       const Belief& belief);

/// ln(E / E of the model) of a material (RobotBody::materials).
UnknownPtr LogYoungsModulus(int material, const std::string& part, double youngs_modulus_Pa,
                            const Belief& belief);
UnknownPtr PoissonsRatioOf(int material, const std::string& part, const Belief& belief);
/// Factor on the mass of the body.
UnknownPtr MassFactor(const Belief& belief);
/// Tangent of the angle by which gravity of all frames is turned about `axis` (unit, robot frame,
/// across gravity); its size grows by half the square of it.
UnknownPtr GravityTilt(const std::string& axis_name, const Eigen::Vector3d& axis,
                       const Belief& belief);

/// s: FrameInputs::scale.
UnknownPtr GeometryScaleOf(const Belief& belief);

struct TiltAxis {
  std::string name;  ///< of the robot axis that it lies nearest to
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/// Two directions across a vector: the robot's axes that it lies least along, as far as they are
/// across it.
std::array<TiltAxis, 2> TiltAxes(const Eigen::Vector3d& gravity_m_s2);

}  // namespace palpate::calibration
