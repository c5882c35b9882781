// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "components/capture/genicam_source.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/capture/node/scripted_source.hpp"
#include "tests/components/capture/simulated_camera.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::capture {
namespace {

using dds::TestNode;
using testing::HasSubstr;

class RunningNode {
 public:
  explicit RunningNode(std::unique_ptr<FrameSource> source, const NodeConfig& config = {})
      : node_{config,
              std::move(source),
              static_cast<int>(dds::TestDomain()),
              dds::BuiltInTable(),
              {}},
        thread_{[this] {
          node_.Run();
          finished_ = true;
        }} {}
  ~RunningNode() {
    node_.Stop();
    thread_.join();
  }
  bool finished() const { return finished_; }

 private:
  CaptureNode node_;
  std::atomic<bool> finished_{false};
  std::thread thread_;
};

/// Keeps what it last saw on each of the camera's topics.
class Subscriber {
 public:
  /// `camera`: name of a camera beside the first.
  explicit Subscriber(const std::string& camera = {})
      : component_(camera.empty() ? "capture" : "capture_" + camera),
        topics_(dds::TopicsOf(camera)),
        node_("subscriber"),
        depth_(node_.participant.CreateReader(topics_.depth, node_.Waker(), camera)),
        color_(node_.participant.CreateReader(topics_.color, node_.Waker(), camera)),
        depth_camera_(node_.participant.CreateReader(topics_.depth_lens, node_.Waker(), camera)),
        color_camera_(node_.participant.CreateReader(topics_.color_lens, node_.Waker(), camera)),
        info_(node_.participant.CreateReader(topics_.frame_info, node_.Waker(), camera)),
        setup_(node_.participant.CreateReader(topics_.setup, node_.Waker(), camera)),
        status_(node_.participant.CreateReader(dds::kComponentStatusTopic)) {
    node_.loop.Every(std::chrono::milliseconds(5), [] {});
    node_.loop.Attach(depth_, [this] { Take(depth_, &depth_frames, &Subscriber::KeepDepth); });
    node_.loop.Attach(color_, [this] { Take(color_, &color_frames, &Subscriber::KeepColor); });
    node_.loop.Attach(depth_camera_, [this] {
      for (const auto& lens : depth_camera_.Take()) {
        fx_px = lens.k[0];
        distortion_k1 = lens.d._length == 5 ? lens.d._buffer[0] : -1.0;
        ++depth_cameras;
      }
    });
    node_.loop.Attach(color_camera_, [this] {
      for (const auto& lens : color_camera_.Take()) color_width = lens.width;
    });
    node_.loop.Attach(info_, [this] { TakeInfo(); });
    node_.loop.Attach(setup_, [this] {
      for (const auto& setup : setup_.Take()) {
        setup_epoch = setup.epoch;
        depth_unit_m = setup.depth_unit_m;
        hash = dds::Text(setup.calibration_hash);
      }
    });
    node_.loop.Attach(status_, [this] {
      for (const auto& status : status_.Take()) {
        if (dds::Text(status.component_name) != component_) continue;
        status_word = dds::Text(status.status);
        status_text = dds::Text(status.reason);
        dropped = status.dropped;
      }
    });
  }

  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.WaitFor(condition);
  }
  bool matched() const {
    return depth_.matched() > 0 && color_.matched() > 0 && info_.matched() > 0;
  }

  rgbd::DepthImage last_depth;
  rgbd::ColorImage last_color;
  std::int64_t depth_stamp_ns = 0, color_stamp_ns = 0, info_stamp_ns = 0;
  std::string depth_frame, color_frame;
  int depth_frames = 0, color_frames = 0, infos = 0, depth_cameras = 0;
  std::uint64_t counter = 0, gaps = 0, dropped = 0;
  std::uint32_t epoch = 0, setup_epoch = 0, color_width = 0;
  double fx_px = 0.0, distortion_k1 = 0.0, depth_unit_m = 0.0;
  std::string hash, status_word, status_text, clock_source;

 private:
  template <typename T>
  void Take(dds::Reader<T>& reader, int* count, void (Subscriber::*keep)(const T&)) {
    for (const T& message : reader.Take()) {
      (this->*keep)(message);
      ++*count;
    }
  }
  void KeepDepth(const idl::sensor_msgs::Image& image) {
    EXPECT_EQ(dds::Text(image.encoding), "16UC1");
    EXPECT_EQ(image.step, 2 * image.width);
    EXPECT_EQ(image.is_bigendian, 0);
    last_depth = rgbd::DepthImage(static_cast<int>(image.width), static_cast<int>(image.height));
    ASSERT_EQ(image.data._length, 2 * last_depth.values.size());
    std::memcpy(last_depth.values.data(), image.data._buffer, image.data._length);
    depth_stamp_ns = dds::StampNs(image.header.stamp);
    depth_frame = dds::Text(image.header.frame_id);
  }
  void KeepColor(const idl::sensor_msgs::Image& image) {
    EXPECT_EQ(dds::Text(image.encoding), "rgb8");
    last_color = rgbd::ColorImage(static_cast<int>(image.width), static_cast<int>(image.height));
    ASSERT_EQ(image.data._length, last_color.values.size());
    std::memcpy(last_color.values.data(), image.data._buffer, image.data._length);
    color_stamp_ns = dds::StampNs(image.header.stamp);
    color_frame = dds::Text(image.header.frame_id);
  }
  void TakeInfo() {
    for (const auto& info : info_.Take()) {
      if (infos > 0 && info.counter != counter + 1) ++gaps;
      counter = info.counter;
      epoch = info.epoch;
      info_stamp_ns = dds::StampNs(info.header.stamp);
      clock_source = dds::Text(info.clock_source);
      ++infos;
    }
  }

  std::string component_;
  dds::CameraTopics topics_;
  TestNode node_;
  dds::Reader<idl::sensor_msgs::Image> depth_;
  dds::Reader<idl::sensor_msgs::Image> color_;
  dds::Reader<idl::sensor_msgs::CameraInfo> depth_camera_;
  dds::Reader<idl::sensor_msgs::CameraInfo> color_camera_;
  dds::Reader<idl::palpate_msgs::FrameInfo> info_;
  dds::Reader<idl::palpate_msgs::CameraSetup> setup_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> status_;
};

std::shared_ptr<SourceFrame> PatternSourceFrame(std::uint16_t index, std::uint32_t epoch,
                                                std::shared_ptr<const rgbd::RgbdCamera> camera) {
  auto frame = std::make_shared<SourceFrame>();
  frame->images = PatternFrame(*camera, index);
  frame->camera = std::move(camera);
  frame->facts.epoch = epoch;
  frame->facts.stamp_host_ns = 1'700'000'000'000'000'000 + index * 1'000'000;
  frame->facts.clock_source = ClockSource::kPtp;
  return frame;
}

SourceHealth Streaming(std::uint32_t epoch) {
  SourceHealth health;
  health.state = SourceState::kStream;
  health.device = "Palpate-1";
  health.epoch = epoch;
  return health;
}

TEST(CaptureNode, PublishesAFrameSetUnderOneStamp) {
  Script script;
  script.Set(Streaming(1));
  RunningNode node(std::make_unique<ScriptedSource>(script));
  Subscriber subscriber;
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.matched(); }));
  const auto camera = std::make_shared<rgbd::RgbdCamera>(SmallCamera());
  const auto frame = PatternSourceFrame(7, 1, camera);
  script.Send(frame);
  ASSERT_TRUE(subscriber.WaitFor([&] {
    return subscriber.depth_frames == 1 && subscriber.color_frames == 1 && subscriber.infos == 1 &&
           subscriber.fx_px > 0.0 && subscriber.setup_epoch == 1 && subscriber.color_width > 0;
  }));
  EXPECT_EQ(subscriber.last_depth, frame->images.depth);
  EXPECT_EQ(subscriber.last_color, frame->images.color);
  EXPECT_EQ(subscriber.depth_stamp_ns, frame->facts.stamp_host_ns);
  EXPECT_EQ(subscriber.color_stamp_ns, frame->facts.stamp_host_ns);
  EXPECT_EQ(subscriber.info_stamp_ns, frame->facts.stamp_host_ns);
  EXPECT_EQ(subscriber.depth_frame, "camera_depth_optical_frame");
  EXPECT_EQ(subscriber.color_frame, "camera_color_optical_frame");
  EXPECT_EQ(subscriber.fx_px, camera->depth.fx_px);
  EXPECT_EQ(subscriber.distortion_k1, camera->depth.distortion[0]);
  EXPECT_EQ(subscriber.depth_unit_m, camera->depth_unit_m);
  EXPECT_EQ(subscriber.clock_source, "ptp");
  EXPECT_EQ(subscriber.hash.size(), 64u);
}

TEST(CaptureNode, OfACameraBesideTheFirstHasTopicsFramesAndStatusOfItsName) {
  Script script;
  script.Set(Streaming(1));
  NodeConfig config;
  config.camera_name = "back";
  RunningNode node(std::make_unique<ScriptedSource>(script), config);
  Subscriber first;
  Subscriber back("back");
  ASSERT_TRUE(back.WaitFor([&] { return back.matched(); }));
  script.Send(PatternSourceFrame(7, 1, std::make_shared<rgbd::RgbdCamera>(SmallCamera())));
  ASSERT_TRUE(back.WaitFor([&] {
    return back.depth_frames == 1 && back.color_frames == 1 && back.infos == 1 &&
           back.setup_epoch == 1 && back.status_word == "ok";
  }));
  EXPECT_EQ(back.depth_frame, "camera_back_depth_optical_frame");
  EXPECT_EQ(back.color_frame, "camera_back_color_optical_frame");
  EXPECT_FALSE(first.matched());
}

TEST(CaptureNode, ALateJoinerGetsCameraAndSetup) {
  Script script;
  script.Set(Streaming(3));
  RunningNode node(std::make_unique<ScriptedSource>(script));
  script.Send(PatternSourceFrame(1, 3, std::make_shared<rgbd::RgbdCamera>(SmallCamera())));
  Subscriber subscriber;
  EXPECT_TRUE(subscriber.WaitFor([&] {
    return subscriber.fx_px > 0.0 && subscriber.setup_epoch == 3 && subscriber.color_width == 200;
  }));
}

TEST(CaptureNode, ANewEpochSendsTheCameraAgainAndTheHashTellsWhetherItChanged) {
  Script script;
  script.Set(Streaming(1));
  RunningNode node(std::make_unique<ScriptedSource>(script));
  Subscriber subscriber;
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.matched(); }));
  const auto camera = std::make_shared<rgbd::RgbdCamera>(SmallCamera());
  script.Send(PatternSourceFrame(1, 1, camera));
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.setup_epoch == 1; }));
  const std::string first = subscriber.hash;
  script.Send(PatternSourceFrame(2, 2, std::make_shared<rgbd::RgbdCamera>(*camera)));
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.setup_epoch == 2; }));
  EXPECT_EQ(subscriber.hash, first);
  rgbd::RgbdCamera moved = *camera;
  moved.depth.cx_px += 0.25;
  script.Send(PatternSourceFrame(3, 3, std::make_shared<rgbd::RgbdCamera>(moved)));
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.setup_epoch == 3; }));
  EXPECT_NE(subscriber.hash, first);
}

TEST(CaptureNode, SaysAtOnceThatTheCameraIsGoneAndThatItIsBack) {
  Script script;
  script.Set(Streaming(1));
  RunningNode node(std::make_unique<ScriptedSource>(script));
  Subscriber subscriber;
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.status_word == "ok"; }));
  SourceHealth gone = Streaming(1);
  gone.state = SourceState::kStale;
  gone.reason = "no frame for 1 s";
  gone.frames_dropped = 5;
  script.Set(gone);
  ASSERT_TRUE(subscriber.WaitFor([&] { return subscriber.status_word == "stale"; }));
  EXPECT_THAT(subscriber.status_text, HasSubstr("no frame for 1 s"));
  EXPECT_EQ(subscriber.dropped, 5u);
  script.Set(Streaming(2));
  EXPECT_TRUE(subscriber.WaitFor([&] { return subscriber.status_word == "ok"; }));
}

TEST(CaptureNode, EndsWithTheRecording) {
  Script script;
  script.Set(Streaming(1));
  RunningNode node(std::make_unique<ScriptedSource>(script));
  Subscriber subscriber;
  SourceHealth ended = Streaming(1);
  ended.state = SourceState::kEnded;
  script.Set(ended);
  subscriber.WaitFor([&] { return node.finished(); });
  EXPECT_TRUE(node.finished());
}

TEST(CaptureNode, FramesOfACameraReachASubscriberWhole) {
  SimulatedCamera camera(LoopbackAddress());
  GenicamSettings settings;
  settings.depth.target.id = LoopbackAddress();
  RunningNode node(std::make_unique<GenicamSource>(settings));
  Subscriber subscriber;
  int checked = 0;
  std::int64_t last_ns = 0;
  ASSERT_TRUE(subscriber.WaitFor([&] {
    const std::int64_t stamp_ns = subscriber.depth_stamp_ns;
    if (stamp_ns == last_ns || stamp_ns != subscriber.color_stamp_ns) return false;
    last_ns = stamp_ns;
    const auto wanted = PatternFrame(camera.camera(), subscriber.last_depth.values[0]);
    EXPECT_EQ(subscriber.last_depth, wanted.depth);
    EXPECT_EQ(subscriber.last_color, wanted.color);
    return ++checked > 30;
  }));
  EXPECT_EQ(subscriber.clock_source, "device_mapped");
}

}  // namespace
}  // namespace palpate::capture
