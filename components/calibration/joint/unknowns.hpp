// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "components/calibration/joint/unknown.hpp"

/// The unknowns there are, one function each. `mean` of a belief is the value to start from; the
/// model and frames hold everything else.
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

/// m: how far the point from which a cable is pulled (the guide before its drive) sits off
/// `pull_point_m`, its place in the robot file, along `direction`; that of a robot of scale 1.
/// Drives count from the undeformed body with the guide where it is. Where it sits along the cable
/// shows in nothing: AcrossCable. The directions of one cable must be square to each other.
UnknownPtr RouteOf(int cable, const std::string& cable_name, const Eigen::Vector3d& pull_point_m,
                   const TiltAxis& direction, const Belief& belief);

/// Two directions across a vector: the robot's axes that it lies least along, as far as they are
/// across it.
std::array<TiltAxis, 2> TiltAxes(const Eigen::Vector3d& gravity_m_s2);

/// Two directions across a cable and square to each other, near TiltAxes of it.
std::array<TiltAxis, 2> AcrossCable(const Eigen::Vector3d& along);
/// The same of its piece from the guide to the body, as the robot file has them.
std::array<TiltAxis, 2> AcrossCable(const robot::BodyCable& cable);

}  // namespace palpate::calibration
