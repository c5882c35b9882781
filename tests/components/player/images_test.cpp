// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/player/node/node.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"

/// Depth and colour played instead of markers.
namespace palpate::player {
namespace {

using ::testing::ElementsAre;

constexpr auto kActuation = "t_s,top.displacement_m\n0,0\n0.25,0.010\n";

/// Two recordings of two frames each at 10 Hz; the first pixel of the depth says which frame it is.
class PlayedImages : public testing::Test {
 protected:
  PlayedImages() {
    WriteRecording("a", 0);
    WriteRecording("b", 10);
    folder_.Write("exp/experiment.yaml", "robot: none.yaml\nframe: camera\n");
  }

  void WriteRecording(const std::string& name, int first) {
    const std::string path = "exp/recordings/" + name;
    folder_.Write(path + "/recording.yaml", "kind: free\n");
    folder_.Write(path + "/actuation.csv", kActuation);
    WriteImages(path, first, 0);
  }

  /// Two frames, so late.
  void WriteImages(const std::string& path, int first, std::int64_t late_ns) {
    rgbd::RgbdCamera camera;
    camera.depth = camera.color = {4, 3, 5.0, 5.0, 1.5, 1.0, {}};
    camera.color_registered = true;
    folder_.Write(path + "/camera.yaml", rgbd::FormatCameraFile(camera));
    for (int i = 0; i < 2; ++i) {
      const std::string file = std::to_string(100'000'000 * i + late_ns) + ".png";
      std::filesystem::create_directories(folder_.path() / path / "depth");
      std::filesystem::create_directories(folder_.path() / path / "color");
      rgbd::WriteDepthPng(folder_.path() / path / "depth" / file,
                          rgbd::DepthImage(4, 3, static_cast<std::uint16_t>(first + i)));
      rgbd::WriteColorPng(folder_.path() / path / "color" / file, rgbd::ColorImage(4, 3, 9));
    }
  }

  ExperimentPlayer Player(const std::string& recording = "") const {
    return ExperimentPlayer::OfImages(
        experiment::ReadExperiment(folder_.path() / "exp", app::LoadYaml), recording,
        app::LoadYaml);
  }

  test_support::TestFolder folder_;
};

TEST_F(PlayedImages, ComeInOrderWithTheCableInputsOfTheirTime) {
  ExperimentPlayer player = Player();
  std::vector<std::string> seen;
  while (const auto event = player.Next()) {
    ASSERT_FALSE(event->markers);
    ASSERT_TRUE(event->images);
    ASSERT_EQ(event->cables.size(), 1u);
    EXPECT_NEAR(event->cables[0].displacement_m.value(), 0.04 * event->t_s, 1e-15);
    EXPECT_EQ(event->images->t_ns, std::llround(1e9 * event->t_s));
    seen.push_back(event->recording + std::to_string(event->images->index));
  }
  EXPECT_THAT(seen, ElementsAre("a0", "a1", "b0", "b1"));
}

TEST_F(PlayedImages, OfSeveralCamerasAreOneFrameWhereTheyBelongTogether) {
  constexpr std::int64_t kLate_ns = 12'000'000;
  WriteImages("exp/recordings/a/cameras/back", 20, kLate_ns);
  ExperimentPlayer player = Player();
  EXPECT_THAT(player.further_cameras(), ElementsAre("back"));
  std::vector<std::string> seen;
  while (const auto event = player.Next()) {
    if (!event->t_ns) continue;
    ASSERT_TRUE(event->images);
    EXPECT_EQ(event->images->t_ns, *event->t_ns);
    seen.push_back(event->recording + std::to_string(event->images->index));
    for (const FurtherImages& further : event->further) {
      EXPECT_EQ(further.images.t_ns, *event->t_ns + kLate_ns);
      seen.back() += further.camera + std::to_string(further.images.index);
    }
  }
  EXPECT_THAT(seen, ElementsAre("a0back0", "a1back1", "b0", "b1"));
}

TEST_F(PlayedImages, RefusesRecordingsWithoutAny) {
  folder_.Write("exp/recordings/c/recording.yaml", "kind: free\n");
  EXPECT_EQ(test_support::MessageOf([&] { Player("c"); }),
            "recording 'c' has no images: nothing to play");
}

/// Answers each frame as perception and estimator together do, once its cables, depth and colour
/// have all come: topics are not in step with each other. Leaves some unanswered once.
class FakeChain {
 public:
  FakeChain()
      : node_("fake_chain"),
        forces_(node_.participant.CreateWriter(dds::kForcesTopic)),
        joint_states_(node_.participant.CreateReader(dds::kJointStatesTopic)),
        depths_(node_.participant.CreateReader(dds::kDepthImageTopic)),
        colors_(node_.participant.CreateReader(dds::kColorImageTopic)),
        infos_(node_.participant.CreateReader(dds::kFrameInfoTopic)) {
    node_.loop.Every(std::chrono::milliseconds(5), [] {});
    node_.loop.Attach(joint_states_, [this] {
      for (const auto& state : joint_states_.Take()) {
        cables_ns_ = dds::StampNs(state.header.stamp);
        TryFrame();
      }
    });
    node_.loop.Attach(depths_, [this] {
      for (const auto& image : depths_.Take()) {
        depth_ns_ = dds::StampNs(image.header.stamp);
        depth_ = image.data._buffer[0];
        TryFrame();
      }
    });
    node_.loop.Attach(colors_, [this] {
      for (const auto& image : colors_.Take()) {
        color_ns_ = dds::StampNs(image.header.stamp);
        TryFrame();
      }
    });
    node_.loop.Attach(infos_, [this] {
      for (const auto& info : infos_.Take()) {
        waiting_ =
            Frame{dds::StampNs(info.header.stamp), info.epoch, std::string(dds::Text(info.device))};
        TryFrame();
      }
    });
  }

  dds::TestNode& node() { return node_; }
  /// Epoch and first pixel of each frame; one that is sent again though it was answered (the answer
  /// was slow) counts once.
  const std::vector<std::string>& frames() const { return frames_; }
  void IgnoreOnce(std::size_t frame) { ignored_ = frame; }

 private:
  struct Frame {
    std::int64_t stamp_ns = 0;
    std::uint32_t epoch = 0;
    std::string device;
    bool operator==(const Frame&) const = default;
  };

  /// Takes the waiting frame if all of it is there.
  void TryFrame() {
    if (!waiting_) return;
    const Frame frame = *waiting_;
    for (const std::int64_t part_ns : {cables_ns_, depth_ns_, color_ns_}) {
      if (part_ns != frame.stamp_ns) return;
    }
    waiting_.reset();
    if (answered_ != frame) {
      frames_.push_back(std::to_string(frame.epoch) + ":" + std::to_string(depth_));
      if (frames_.size() == ignored_) return;
    }
    answered_ = frame;
    dds::Message<idl::palpate_msgs::ForceArray> forces;
    dds::SetHeader(forces->header, frame.stamp_ns, "robot");
    dds::SetText(forces->recording, frame.device);
    EXPECT_TRUE(forces_.Write(forces));
  }

  dds::TestNode node_;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::sensor_msgs::Image> depths_;
  dds::Reader<idl::sensor_msgs::Image> colors_;
  dds::Reader<idl::palpate_msgs::FrameInfo> infos_;
  std::vector<std::string> frames_;
  std::int64_t cables_ns_ = -1, depth_ns_ = -1, color_ns_ = -1;  ///< of what came last
  int depth_ = -1;                                               ///< first pixel
  std::optional<Frame> waiting_;                                 ///< not all of it has come yet
  std::optional<Frame> answered_;                                ///< the last one
  std::size_t ignored_ = 0;
};

TEST_F(PlayedImages, InStepsEachFrameWaitsForItsAnswerAndEachRecordingIsAnEpoch) {
  FakeChain chain;
  chain.IgnoreOnce(2);
  NodeConfig config;
  config.resend_s = 0.05;
  PlayerNode player(config, {.step = true}, Player(), static_cast<int>(dds::TestDomain()),
                    dds::BuiltInTable(), {});
  std::atomic<bool> finished = false;
  std::thread thread([&] {
    player.Run();
    finished = true;
  });
  EXPECT_TRUE(chain.node().WaitFor([&] { return finished.load(); }));
  player.Stop();
  thread.join();
  EXPECT_THAT(chain.frames(), ElementsAre("1:0", "1:1", "1:1", "2:10", "2:11"));
}

TEST_F(PlayedImages, PutTheCameraBelowTheRobotWhereTheExperimentSaysSo) {
  folder_.Write("exp/experiment.yaml",
                "robot: none.yaml\nframe: camera\nT_robot_camera: {translation_m: [0, 0.2, 0.5], "
                "rotation_xyzw: {x: 0, y: 0, z: 0, w: 1}}\n");
  FakeChain chain;
  auto transforms = chain.node().participant.CreateReader(dds::kTfStaticTopic);
  dds::TransformTree tree;
  chain.node().loop.Attach(transforms, [&] {
    for (const auto& message : transforms.Take()) EXPECT_TRUE(tree.Add(message).ok());
  });
  PlayerNode player({}, {.step = true}, Player("a"), static_cast<int>(dds::TestDomain()),
                    dds::BuiltInTable(), {});
  std::thread thread([&] { player.Run(); });
  EXPECT_TRUE(chain.node().WaitFor([&] {
    const auto T_robot_camera = tree.Find("robot", "camera_depth_optical_frame");
    return T_robot_camera && T_robot_camera->translation() == Eigen::Vector3d(0, 0.2, 0.5);
  }));
  player.Stop();
  thread.join();
}

}  // namespace
}  // namespace palpate::player
