// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/simulation.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// By how much farther a finer mesh would let the body move, as far as that is linear in how the
/// body is bent. Of other loads and cables than it was found with it tells a half or more: enough
/// to know this fault from others.
struct MeshError {
  Eigen::MatrixXd shapes;            ///< [3n x shapes] orthonormal, in which bodies are bent
  Eigen::MatrixXd of_nodes;          ///< [3n x shapes] m of motion per m of bend in each
  Eigen::MatrixXd of_markers;        ///< [3 markers x shapes] the same
  double relative = 0.0;             ///< RMS over nodes and samples, of how far they had moved
  double share_beyond_shapes = 0.0;  ///< of its square that is not linear in them

  /// [shapes] of a body whose nodes have moved by `bend_m` [3n] from rest.
  Eigen::VectorXd BendIn(const Eigen::VectorXd& bend_m) const {
    return shapes.transpose() * bend_m;
  }
};

/// `simulated` on the mesh of `body`, and `on_finer` on that of `finer`, of which the first nodes
/// are those of the former; the same robot and experiment. Samples that failed on either are left
/// out; nothing where none is left, or nothing moves.
std::optional<MeshError> CompareMeshes(const robot::RobotBody& body, const Simulation& simulated,
                                       const robot::RobotBody& finer, const Simulation& on_finer);

/// The robot on elements of ten nodes.
robot::RobotDescription OnFinerMesh(robot::RobotDescription robot);

/// What the mesh of `robot` errs by in an experiment that was simulated on it: of elements with
/// four nodes, against the same elements with ten, on `threads`. Nothing of meshes that have these
/// already: what they err by smoothly is within the noise model, and what the points yield by at
/// which cables end has no limit that finer ones would come nearer to. Nothing either of a mass
/// that is shared by the nodes (other nodes are another body), or where the finer mesh finds no
/// balance.
std::shared_ptr<const MeshError> CompareWithFinerMesh(const robot::RobotDescription& robot,
                                                      const robot::RobotBody& body,
                                                      const ObservedExperiment& observed,
                                                      const Simulation& simulated, int threads);

}  // namespace palpate::diagnosis
