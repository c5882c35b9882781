// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/convert_markers.hpp"
#include "tests/components/perception/markers/marked_scene.hpp"
#include "tests/components/perception/node/node_fixture.hpp"

/// Coloured discs on the robot, from rendered images to /perception/markers.
namespace palpate::perception {
namespace {

TEST(ToMarkerArray, GivesEachFiducialItsPlaceSigmasAndNameWhereItHasOne) {
  FiducialFrame frame;
  frame.status = Status::Ok();
  frame.fiducials.resize(2);
  frame.fiducials[0].position_m = {0.1, 0.2, 0.3};
  frame.fiducials[0].covariance_m2 << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 0.0, 0.0, 0.0, 16e-6;
  frame.fiducials[1].name = "tip";
  const auto message = ToMarkerArray(frame, 1'500'000'000);
  EXPECT_EQ(dds::StampNs(message->header.stamp), 1'500'000'000);
  EXPECT_EQ(dds::Text(message->header.frame_id), "camera_depth_optical_frame");
  EXPECT_EQ(message->reference_shape, 0);
  ASSERT_EQ(message->markers._length, 2u);
  const auto& first = message->markers._buffer[0];
  EXPECT_EQ(dds::Text(first.name), "");
  EXPECT_EQ(first.position_m.y, 0.2);
  EXPECT_NEAR(first.sigma_m.x, 2e-3, 1e-12);
  EXPECT_NEAR(first.sigma_m.y, 3e-3, 1e-12);
  EXPECT_NEAR(first.sigma_m.z, 4e-3, 1e-12);
  EXPECT_EQ(Eigen::Map<const Eigen::Matrix3d>(first.covariance_m2),
            frame.fiducials[0].covariance_m2);
  EXPECT_TRUE(first.valid);
  EXPECT_EQ(dds::Text(message->markers._buffer[1].name), "tip");
}

TEST(ToMarkerArray, AFrameThatCannotBeUsedHasNone) {
  FiducialFrame frame;
  frame.fiducials.resize(1);
  frame.status = Status(StatusCode::kInvalidInput, "the camera has no colours");
  EXPECT_EQ(ToMarkerArray(frame, 7)->markers._length, 0u);
}

class FiducialsOnTheirTopic : public PerceptionNodeTest {
 protected:
  struct Seen {
    std::int64_t stamp_ns = 0;
    Eigen::Matrix3Xd positions_m;
    Eigen::Matrix3Xd sigmas_m;
  };

  FiducialsOnTheirTopic()
      : markers_(test_.participant.CreateReader(dds::kMarkersTopic, test_.Waker())) {
    test_.loop.Attach(markers_, [this] {
      for (const auto& message : markers_.Take()) Keep(message);
    });
  }

  void Keep(const idl::palpate_msgs::MarkerArray3& message) {
    const auto count = static_cast<Eigen::Index>(message.markers._length);
    Seen seen{dds::StampNs(message.header.stamp), Eigen::Matrix3Xd(3, count),
              Eigen::Matrix3Xd(3, count)};
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto& marker = message.markers._buffer[k];
      EXPECT_TRUE(marker.valid);
      seen.positions_m.col(k) << marker.position_m.x, marker.position_m.y, marker.position_m.z;
      seen.sigmas_m.col(k) << marker.sigma_m.x, marker.sigma_m.y, marker.sigma_m.z;
    }
    seen_.push_back(std::move(seen));
  }

  static scenario::Scenario FromAbove() {
    scenario::Scenario scenario = MarkedScenario();
    PlaceCamera(0.45, -30.0, 88.0, &scenario);
    return scenario;
  }

  const scenario::Scenario scenario_ = FromAbove();
  dds::Reader<idl::palpate_msgs::MarkerArray3> markers_;
  std::vector<Seen> seen_;
};

TEST_F(FiducialsOnTheirTopic, RenderedOnesComeOutWhereTheyAreWithinTheirSigmas) {
  NodeConfig config = TestConfig();
  config.markers.color_rgb = ConfigOf(scenario_).color_rgb;
  StartNode(config, false, MakeFramePerception);
  ASSERT_TRUE(test_.WaitFor([this] { return markers_.matched() == 1; }));
  MarkedScene scene(FourLegSurface(), scenario_);
  const rgbd::RgbdFrame& frame = scene.Take(scene.Rest());
  const rgbd::RgbdCamera& camera = scenario_.camera->camera;
  SendCamera(camera, 1, 5);
  SendFrame(10, frame, camera);
  ASSERT_TRUE(test_.WaitFor([this] { return !seen_.empty(); }));
  EXPECT_EQ(seen_[0].stamp_ns, 10);
  FiducialDetector detector(FiducialsOf(config));
  detector.SetCamera(camera);
  const std::vector<Fiducial>& expected = detector.Detect(frame).fiducials;
  ASSERT_EQ(seen_[0].positions_m.cols(), static_cast<Eigen::Index>(expected.size()));
  EXPECT_GE(expected.size(), 4u);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    EXPECT_EQ(seen_[0].positions_m.col(column), expected[k].position_m) << "bit for bit";
    const int marker = NearestMarker(scene.truth(), expected[k]);
    ASSERT_GE(marker, 0);
    const Eigen::Vector3d off_m = seen_[0].positions_m.col(column) -
                                  scene.truth()[static_cast<std::size_t>(marker)].position_m;
    EXPECT_LT(off_m.cwiseQuotient(seen_[0].sigmas_m.col(column)).cwiseAbs().maxCoeff(), 4.0);
  }
}

TEST_F(FiducialsOnTheirTopic, TheTopicIsLeftToOthersWhereNoColourIsTold) {
  StartNode(TestConfig(), true, MakeFramePerception);
  const rgbd::RgbdCamera& camera = scenario_.camera->camera;
  MarkedScene scene(FourLegSurface(), scenario_);
  SendCamera(camera, 1, 5);
  SendFrame(10, scene.Take(scene.Rest()), camera);
  ASSERT_TRUE(WaitForAnswer(10));
  EXPECT_EQ(markers_.matched(), 0u);
  EXPECT_TRUE(seen_.empty());
}

}  // namespace
}  // namespace palpate::perception
