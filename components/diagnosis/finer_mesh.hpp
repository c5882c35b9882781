// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/model/mesh_error.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// The robot on cells of ten nodes.
robot::RobotDescription OnFinerMesh(robot::RobotDescription robot);

/// What the mesh of `robot` errs by in an experiment that was simulated on it: of cells with four
/// nodes, against the same cells with ten, on `threads`. Nothing of meshes that have these already:
/// what they err by smoothly is within the noise model, and what the points give way by at which
/// cables end has no limit that finer ones would come nearer to. Nothing either of a mass that is
/// shared by the nodes (other nodes are another body), or where the finer mesh finds no balance.
std::shared_ptr<const MeshError> CompareWithFinerMesh(const robot::RobotDescription& robot,
                                                      const robot::RobotBody& body,
                                                      const ObservedExperiment& observed,
                                                      const Simulation& simulated, int threads);

}  // namespace palpate::diagnosis
