// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/finer_mesh.hpp"

#include "components/diagnosis/model/simulator.hpp"

namespace palpate::diagnosis {

robot::RobotDescription OnFinerMesh(robot::RobotDescription robot) {
  robot.element = fem::ElementType::kTet10;
  return robot;
}

std::shared_ptr<const MeshError> CompareWithFinerMesh(const robot::RobotDescription& robot,
                                                      const robot::RobotBody& body,
                                                      const ObservedExperiment& observed,
                                                      const Simulation& simulated, int threads) {
  if (robot.element != fem::ElementType::kTet4) return nullptr;
  const robot::RobotBody finer_body = robot::BuildRobotBody(OnFinerMesh(robot));
  const Simulation on_finer = Simulator(observed, threads).Run(DraftOf(finer_body, observed));
  const auto error = CompareMeshes(body, simulated, finer_body, on_finer);
  return error ? std::make_shared<const MeshError>(*error) : nullptr;
}

}  // namespace palpate::diagnosis
