// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/finer_mesh.hpp"

#include <algorithm>
#include <vector>

#include "components/diagnosis/model/simulator.hpp"

namespace palpate::diagnosis {

namespace {

/// How bodies are bent shows in so many moments.
constexpr std::size_t kMostSamples = 40;

/// Numbers of so many samples, spread evenly.
std::vector<std::size_t> SomeOf(const ObservedExperiment& observed) {
  const std::size_t all = observed.samples.size();
  const std::size_t count = std::min(all, kMostSamples);
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < count; ++k) some.push_back(k * all / count);
  return some;
}

}  // namespace

robot::RobotDescription OnFinerMesh(robot::RobotDescription robot) {
  robot.element = fem::ElementType::kTet10;
  return robot;
}

std::shared_ptr<const MeshError> CompareWithFinerMesh(const robot::RobotDescription& robot,
                                                      const robot::RobotBody& body,
                                                      const ObservedExperiment& observed,
                                                      const Simulation& simulated, int threads) {
  const bool has_own_weight = robot.mass.distribution == robot::MassDistribution::kPerNode;
  if (robot.element != fem::ElementType::kTet4 || has_own_weight) return nullptr;
  const robot::RobotBody finer_body = robot::BuildRobotBody(OnFinerMesh(robot));
  ObservedExperiment few = observed;
  few.samples.clear();
  Simulation coarse;
  for (const std::size_t s : SomeOf(observed)) {
    few.samples.push_back(observed.samples[s]);
    SimulatedSample& known = coarse.samples.emplace_back();
    known.status = simulated.samples[s].status;
    known.middle.state = simulated.samples[s].middle.state;
  }
  // Ends with the first sample that fails: cells so bad that ten nodes buckle fail all, and slowly.
  const Simulation nothing;
  const Simulation on_finer = Simulator(few, threads).Run(DraftOf(finer_body, few), &nothing);
  const auto error = CompareMeshes(body, coarse, finer_body, on_finer);
  return error ? std::make_shared<const MeshError>(*error) : nullptr;
}

}  // namespace palpate::diagnosis
