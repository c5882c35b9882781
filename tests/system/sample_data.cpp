// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/sample_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::system_test {

namespace {

std::filesystem::path SourceFile(const std::string& name) {
  return std::filesystem::path(PALPATE_SOURCE_DIR) / name;
}

/// Keeps about `count` frames, evenly spread.
void Thin(experiment::MarkerTracks& tracks, size_t count) {
  const size_t step = std::max<size_t>(1, tracks.frames.size() / count);
  std::vector<experiment::MarkerFrame> kept;
  for (size_t i = 0; i < tracks.frames.size(); i += step) kept.push_back(tracks.frames[i]);
  tracks.frames = std::move(kept);
}

std::vector<std::optional<Eigen::Vector3d>> MarkerPositions(robot::RobotModel& model,
                                                            double north_m,
                                                            const Eigen::Vector3d& top_force_N) {
  std::vector<robot::ActuatorCommand> cables(static_cast<size_t>(model.ActuatorCount()));
  cables[0] = {robot::ActuatorCommand::Kind::kDisplacement, north_m};
  cables[1] = {robot::ActuatorCommand::Kind::kTension, 1.0};
  fem::StaticState state = model.RestState();
  const auto patch = model.Patch({0.0, 0.0, 0.12}, 0.006);
  EXPECT_TRUE(model.Solve(cables, {{patch.weights, top_force_N}}, &state).status.ok());
  std::vector<std::optional<Eigen::Vector3d>> positions_m;
  for (const auto& marker : model.body().markers) {
    positions_m.push_back(marker.point.weights.Position(state.x_m));
  }
  return positions_m;
}

}  // namespace

Sample WriteBeamSample(const TestFolder& folder, size_t frame_count) {
  auto experiment =
      experiment::ReadExperiment(SourceFile("tests/data/beam_calculix"), app::LoadYaml);
  for (auto& recording : experiment.recordings) Thin(*recording.markers, frame_count);
  experiment::WriteExperiment(experiment, folder / "data");
  // The robot file's modulus is not that of the data: without calibration the weight is a force.
  return {SourceFile("config/robots/beam.yaml"), folder / "data", "tip: 0, 0.015, 0.03, 0.004", 1};
}

Sample WriteFourLegSample(const TestFolder& folder) {
  const auto robot_file = SourceFile("config/robots/four_leg.yaml");
  robot::RobotModel model(robot::BuildRobotBody(robot::ReadRobotFile(robot_file, app::LoadYaml)));
  experiment::Recording recording;
  recording.name = "pulled";
  recording.reference =
      experiment::Reference{{0.0, 0.05}, experiment::ReferenceShape::kEquilibrium};
  recording.markers.emplace();
  recording.markers->names = model.MarkerNames();
  recording.actuation.emplace();
  using Quantity = experiment::ActuatorQuantity;
  recording.actuation->columns = {{model.ActuatorNames()[0], Quantity::kDisplacement, {}, {}},
                                  {model.ActuatorNames()[1], Quantity::kTension, {}, {}}};
  // Rows of actuation.csv at every second frame only: the inputs between them are interpolated.
  for (int i = 0; i <= 4; ++i) {
    const double t_s = 0.1 * i;
    const double north_m = 0.001 * i;
    const Eigen::Vector3d force_N(0.05 * i, 0.0, -0.1 * i);
    recording.markers->frames.push_back({t_s, MarkerPositions(model, north_m, force_N), 0});
    if (i % 2 == 1) continue;
    recording.actuation->t_s.push_back(t_s);
    recording.actuation->columns[0].samples.push_back(north_m);
    recording.actuation->columns[1].samples.push_back(1.0);
  }
  experiment::Experiment experiment;
  experiment.markers_sigma_m = Eigen::Vector3d(1e-4, 1e-4, 2e-4);
  experiment.recordings = {recording};
  experiment::WriteExperiment(experiment, folder / "data");
  return {robot_file, folder / "data", "top: 0, 0, 0.12, 0.006"};
}

}  // namespace palpate::system_test
