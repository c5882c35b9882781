// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/node/command_line.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/topics.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"

/// palpate-force-estimation starts with the size that the calibration found.
namespace palpate::force_estimation {
namespace {

TEST(CalibratedSize, IsThatOfTheMeshWhichThePublishedModelHas) {
  constexpr double kScale = 1.25;
  const test_support::TestFolder folder;
  Command command;
  command.robot = std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots/beam.yaml";
  command.calibration = folder.path() / "calibration.yaml";
  command.options.domain_id = static_cast<int>(dds::TestDomain());
  const robot::RobotBody body =
      robot::BuildRobotBody(robot::ReadRobotFile(command.robot, app::LoadYaml));
  robot::CalibrationFile calibration = robot::DescribeForCalibration(robot::RobotModel(body));
  calibration.date_utc = calibration.data = calibration.data_hash = "some";
  calibration.geometry_scale = robot::CalibratedScale{kScale, 1e-3};
  robot::WriteCalibrationFile(calibration, command.calibration);
  const auto node = MakeNode(command);
  dds::TestNode test("test");
  auto meshes = test.participant.CreateReader(dds::kMeshTopic, test.Waker());
  Eigen::Matrix3Xd nodes_m;
  test.loop.Attach(meshes, [&] {
    for (const auto& message : meshes.Take()) {
      nodes_m = Eigen::Map<const Eigen::Matrix3Xd>(message.nodes_m._buffer, 3,
                                                   message.nodes_m._length / 3);
    }
  });
  ASSERT_TRUE(test.WaitFor([&] { return nodes_m.cols() > 0; }));
  EXPECT_TRUE(nodes_m.isApprox(kScale * body.mesh.nodes_m, 1e-6));
}

}  // namespace
}  // namespace palpate::force_estimation
