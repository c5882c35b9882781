// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "components/calibration/joint/unknown.hpp"

/// The kinds of unknowns, one function each; those of cable routes are in route_unknowns.hpp. The
/// prior mean is the initial value.
namespace palpate::calibration {

/// Displacement (m) or tension (N) of a cable in one frame, in place of the frame's command.
UnknownPtr CableInput(int frame, const std::string& frame_name, int cable,
                      const std::string& cable_name, robot::ActuatorCommand::Kind kind,
                      const GaussianPrior& prior);

/// o, m: a commanded displacement u of this cable is (1 + g) u + o in each frame.
UnknownPtr CommandOffset(int cable, const std::string& cable_name, const GaussianPrior& prior);
/// g; `measured`: the displacements u, one per frame.
UnknownPtr CommandGain(int cable, const std::string& cable_name, std::vector<double> measured,
                       const GaussianPrior& prior);

/// ln(E / E of the model) of a material (RobotBody::materials).
UnknownPtr LogYoungsModulus(int material, const std::string& part, double youngs_modulus_Pa,
                            const GaussianPrior& prior);
UnknownPtr PoissonsRatioOf(int material, const std::string& part, const GaussianPrior& prior);
/// Factor on the mass of the body.
UnknownPtr MassFactor(const GaussianPrior& prior);
/// Tangent of the angle by which gravity of all frames is turned about `axis` (unit, robot frame,
/// across gravity). Linear: the size of gravity grows by half the square of it.
UnknownPtr GravityTilt(const std::string& axis_name, const Eigen::Vector3d& axis,
                       const GaussianPrior& prior);

/// s: FrameInputs::scale.
UnknownPtr GeometryScaleOf(const GaussianPrior& prior);

struct TiltAxis {
  std::string name;  ///< of the nearest robot axis
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/// Two directions across a vector: the projections of the two robot axes that are least parallel to
/// it.
std::array<TiltAxis, 2> TiltAxes(const Eigen::Vector3d& gravity_m_s2);

}  // namespace palpate::calibration
