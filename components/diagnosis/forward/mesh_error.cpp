// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/mesh_error.hpp"

#include <algorithm>
#include <vector>

#include "components/diagnosis/forward/simulator.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/svd.hpp"

namespace palpate::diagnosis {

namespace {

/// [3 markers] where they are, robot frame.
Eigen::VectorXd MarkersAt(const robot::RobotBody& body, const Eigen::VectorXd& x_m) {
  Eigen::VectorXd markers_m(3 * std::ssize(body.markers));
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    markers_m.segment<3>(3 * ToIndex(m)) = body.markers[m].point.weights.Position(x_m);
  }
  return markers_m;
}

}  // namespace

std::optional<MeshError> CompareMeshes(const robot::RobotBody& body, const Simulation& simulated,
                                       const robot::RobotBody& finer, const Simulation& on_finer) {
  constexpr double kLeast = 0.01;  // of the largest shape; what is less is not bent alike twice
  std::vector<std::size_t> known;
  for (std::size_t s = 0; s < simulated.samples.size(); ++s) {
    if (simulated.samples[s].status.ok() && on_finer.samples[s].status.ok()) known.push_back(s);
  }
  const Eigen::VectorXd rest_m = body.mesh.nodes_m.reshaped();
  Eigen::MatrixXd bend_m(rest_m.size(), std::ssize(known));
  Eigen::MatrixXd nodes_m(rest_m.size(), std::ssize(known));
  Eigen::MatrixXd markers_m(3 * std::ssize(body.markers), std::ssize(known));
  for (std::size_t k = 0; k < known.size(); ++k) {
    const Eigen::VectorXd& x_m = simulated.samples[known[k]].middle.state.x_m;
    const Eigen::VectorXd& finer_x_m = on_finer.samples[known[k]].middle.state.x_m;
    const auto column = ToIndex(k);
    bend_m.col(column) = x_m - rest_m;
    nodes_m.col(column) = finer_x_m.head(rest_m.size()) - x_m;
    markers_m.col(column) = MarkersAt(finer, finer_x_m) - MarkersAt(body, x_m);
  }
  if (known.empty() || bend_m.isZero(0.0)) return std::nullopt;
  const linalg::ThinSvd svd = linalg::DecomposeSvd(bend_m);
  const Eigen::VectorXd& size_m = svd.values;
  const Eigen::Index count = (size_m.array() > kLeast * size_m[0]).count();
  const Eigen::MatrixXd per_sample =
      svd.V.leftCols(count) * size_m.head(count).cwiseInverse().asDiagonal();
  MeshError error;
  error.shapes = svd.U.leftCols(count);
  error.of_nodes = nodes_m * per_sample;
  error.of_markers = markers_m * per_sample;
  error.relative = nodes_m.norm() / bend_m.norm();
  const Eigen::MatrixXd linear_m = error.of_nodes * (error.shapes.transpose() * bend_m);
  error.share_beyond_shapes = (nodes_m - linear_m).squaredNorm() / nodes_m.squaredNorm();
  return error;
}

namespace {

/// How bodies are bent shows in so many samples.
constexpr std::size_t kMostSamples = 40;

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
  for (const std::size_t s : SpreadOver(observed.samples.size(), kMostSamples)) {
    few.samples.push_back(observed.samples[s]);
    SimulatedSample& known = coarse.samples.emplace_back();
    known.status = simulated.samples[s].status;
    known.middle.state = simulated.samples[s].middle.state;
  }
  // Ends with the first sample that fails: elements so bad that ten nodes buckle fail all, and
  // slowly.
  const Simulation nothing;
  const Simulation on_finer =
      Simulator(few, threads).Run(NominalHypothesis(finer_body, few), &nothing);
  const auto error = CompareMeshes(body, coarse, finer_body, on_finer);
  return error ? std::make_shared<const MeshError>(*error) : nullptr;
}

}  // namespace palpate::diagnosis
