// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/node/node_fixture.hpp"

/// Which state of the model a frame is segmented with.
namespace palpate::perception {
namespace {

class PredictionTest : public PerceptionNodeTest {
 protected:
  /// With a camera, a mesh, and the states of the mesh known to the node.
  void StartWith(NodeConfig config) {
    StartNode(config);
    SendMesh();
    SendCamera(SmallCamera(), 1, 1);
  }
  std::optional<double> LastPredictionZ_m() const {
    const auto vertex_m = script_.calls().back().first_vertex_m;
    return vertex_m ? std::optional<double>(vertex_m->z()) : std::nullopt;
  }
};

TEST_F(PredictionTest, IsTheNewestStateFromBeforeTheFrameInTheCamerasFrame) {
  StartWith(TestConfig());
  EXPECT_EQ(Ask(1 * kSecond_ns).prediction_ns, 0);
  const std::int64_t stamp_ns = 2 * kSecond_ns;
  SendMeshState(stamp_ns - 200, 0.125);
  SendMeshState(stamp_ns - 100, 0.25);
  SendMeshState(stamp_ns, 0.75);
  // Readers of states do not wait for each other: ask until the node has them.
  std::int64_t frame_ns = stamp_ns;
  while (Ask(frame_ns).prediction_ns == 0 && frame_ns < stamp_ns + 100) ++frame_ns;
  EXPECT_EQ(answers_.back().prediction_ns, frame_ns == stamp_ns ? stamp_ns - 100 : stamp_ns);
  EXPECT_EQ(LastPredictionZ_m(), (frame_ns == stamp_ns ? 0.25 : 0.75) - 0.5);
}

TEST_F(PredictionTest, IsNotUsedWhenItIsTooOld) {
  NodeConfig config = TestConfig();
  config.max_prediction_age_s = 0.5;
  StartWith(config);
  SendMeshState(1 * kSecond_ns, 0.25);
  // Until it is there.
  for (std::int64_t i = 1; i < 100 && Ask(kSecond_ns + i).prediction_ns == 0;) ++i;
  ASSERT_EQ(answers_.back().prediction_ns, kSecond_ns);
  EXPECT_EQ(Ask(2 * kSecond_ns).prediction_ns, 0);
  EXPECT_EQ(LastPredictionZ_m(), std::nullopt);
}

TEST_F(PredictionTest, IsAwaitedWhereItIsToBeThatOfTheFrameBefore) {
  NodeConfig config = TestConfig();
  config.await_prediction_s = 600.0;
  StartWith(config);
  Ask(1 * kSecond_ns);
  SendFrame(1 * kSecond_ns + 100);
  ASSERT_TRUE(test_.WaitFor([&] { return received_ == 2; }));
  EXPECT_EQ(script_.calls().size(), 1u);
  SendMeshState(1 * kSecond_ns, 0.25);
  ASSERT_TRUE(WaitForAnswer(1 * kSecond_ns + 100));
  EXPECT_EQ(answers_.back().prediction_ns, 1 * kSecond_ns);
  EXPECT_EQ(LastPredictionZ_m(), 0.25 - 0.5);
}

TEST_F(PredictionTest, ThatDoesNotComeIsAwaitedNoLongerThanItIsWorth) {
  NodeConfig config = TestConfig();
  config.await_prediction_s = 1.0;
  StartWith(config);
  Ask(1 * kSecond_ns);
  // No state of the model follows, nor anything else that would wake the node.
  EXPECT_EQ(Ask(1 * kSecond_ns + 100).prediction_ns, 0);
}

TEST_F(PredictionTest, IsKeptInTheNextRecordingOfADevice) {
  NodeConfig config = TestConfig();
  config.await_prediction_s = 600.0;
  StartWith(config);
  Ask(5 * kSecond_ns);
  SendMeshState(5 * kSecond_ns, 0.25);
  SendCamera(SmallCamera(), 2, 1);
  EXPECT_EQ(Ask(1 * kSecond_ns).prediction_ns, 5 * kSecond_ns);
  EXPECT_EQ(script_.calls()[1].perception, script_.calls()[0].perception);
}

TEST_F(PredictionTest, OfAnotherSequenceIsForgotten) {
  NodeConfig config = TestConfig();
  config.await_prediction_s = 600.0;
  StartWith(config);
  Ask(1 * kSecond_ns);
  SendMeshState(1 * kSecond_ns, 0.25);
  EXPECT_EQ(Ask(1 * kSecond_ns + 100).prediction_ns, 1 * kSecond_ns);
  SendCamera(SmallCamera(), 2, 1, "Palpate-2");
  EXPECT_EQ(Ask(1 * kSecond_ns + 200).prediction_ns, 0);
}

TEST_F(PredictionTest, IsNoneWithoutTheCamerasPose) {
  NodeConfig config = TestConfig();
  StartNode(config, false);
  SendMesh();
  SendCamera(SmallCamera(), 1, 1);
  SendMeshState(1 * kSecond_ns, 0.25);
  EXPECT_EQ(Ask(1 * kSecond_ns + 100).status, "ok");
  EXPECT_EQ(LastPredictionZ_m(), std::nullopt);
}

TEST(PredictionHistory, RefusesStatesOfAnotherMeshAndThoseThatAreNone) {
  PredictionHistory history;
  const Eigen::Matrix3Xd nodes_m = Eigen::Matrix3Xd::Identity(3, 3);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  // Before its mesh: it waits for it.
  EXPECT_TRUE(history.Add(*dds::ToMeshState(Eigen::VectorXd::Zero(9), "hash", 10)).ok());
  EXPECT_FALSE(history.Before(30, 1.0, pose));
  ASSERT_TRUE(
      history
          .SetMesh(*dds::ToMesh(
              {"robot", "hash", nodes_m, Eigen::MatrixXi(4, 0), Eigen::Vector3i(0, 1, 2)}, 0))
          .ok());
  EXPECT_TRUE(history.Before(30, 1.0, pose));
  EXPECT_EQ(history.Add(*dds::ToMeshState(Eigen::VectorXd::Zero(9), "other", 20)).code(),
            StatusCode::kInvalidInput);
  EXPECT_EQ(history.Add(*dds::ToMeshState(Eigen::VectorXd::Zero(6), "hash", 20)).code(),
            StatusCode::kInvalidInput);
  EXPECT_FALSE(history.IsAnswered(20));
  // Without positions: an answer, but no state.
  EXPECT_TRUE(history.Add(*dds::ToMeshState(Eigen::VectorXd(), "hash", 20)).ok());
  EXPECT_TRUE(history.IsAnswered(20));
  const auto found = history.Before(30, 1.0, pose);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stamp_ns, 10);
}

}  // namespace
}  // namespace palpate::perception
