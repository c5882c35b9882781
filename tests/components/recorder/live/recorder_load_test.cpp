// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <map>

#include "idl/message_traits.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/camera_publisher.hpp"
#include "std_msgs/msg/Header.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

/// The recorder under the load of a camera and all else that a system sends, in real time.
namespace palpate::recorder {
namespace {

using dds::TestNode;
using system_test::Process;
using test_support::TestFolder;
using testing::HasSubstr;

double ChildCpu_s() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// 848 x 480 depth that changes from pixel to pixel as a stereo camera's does, and colour.
class SampleCamera {
 public:
  SampleCamera() {
    camera_.depth.width_px = camera_.color.width_px = 848;
    camera_.depth.height_px = camera_.color.height_px = 480;
    frame_.depth.width_px = frame_.color.width_px = 848;
    frame_.depth.height_px = frame_.color.height_px = 480;
    frame_.depth.values.resize(848 * 480);
    frame_.color.values.resize(848 * 480 * 3);
    std::uint32_t noise = 1;
    for (auto& value : frame_.depth.values) {
      noise = noise * 1664525 + 1013904223;
      value = static_cast<std::uint16_t>(500 + (noise >> 28));
    }
    for (auto& value : frame_.color.values) {
      noise = noise * 1664525 + 1013904223;
      value = static_cast<std::uint8_t>(100 + (noise >> 29));
    }
  }

  [[nodiscard]] bool Publish(dds::CameraPublisher& publisher, std::int64_t stamp_ns) {
    idl::palpate_msgs::FrameInfo info{};
    return publisher.PublishFrame(camera_, frame_, stamp_ns, info);
  }

 private:
  rgbd::RgbdCamera camera_;
  rgbd::RgbdFrame frame_;
};

/// Settings for one host, as its user has them.
class RecorderLoad : public testing::Test {
 protected:
  RecorderLoad() {
    setenv("CYCLONEDDS_URI", "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/one_host.xml", 1);
  }
};

/// How many messages of each topic came from a time on.
std::map<std::string, int> CountsFrom(std::int64_t start_ns, const std::filesystem::path& file) {
  const recording::Reader reader(file);
  recording::MessageFilter filter;
  filter.start_time_ns = start_ns;
  recording::MessageStream stream = reader.Messages(filter);
  std::map<std::string, int> counts;
  while (const recording::Message* message = stream.Next()) {
    ++counts[reader.contents().channels.at(message->channel_id).topic];
  }
  return counts;
}

TEST_F(RecorderLoad, LosesNoFrameAt30HzAndCostsAtMostThreeTimesACopy) {
  constexpr int kFrames = 60 * 30;
  const TestFolder folder;
  const auto file = folder / "run.mcap";
  TestNode robot("robot");
  dds::CameraPublisher publisher(robot.participant);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  robot.loop.Every(std::chrono::milliseconds(5), [] {});
  SampleCamera camera;
  Process recorder("palpate-recorder", {"--out", file.string()}, folder / "log.txt");
  ASSERT_TRUE(robot.WaitFor([&] { return publisher.is_read() && markers.matched() > 0; }));
  // A reader gets what is sent once it knows the writer; the first frame waits for that.
  ASSERT_TRUE(camera.Publish(publisher, 0));
  ASSERT_TRUE(publisher.WaitUntilReceived(std::chrono::seconds(5)));
  const std::int64_t start_ns = WallNow_ns();
  const double cpu_before_s = recorder.CpuTime_s();
  const auto start = dds::WaitSet::Clock::now();
  double memory_MiB = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    robot.loop.DispatchUntil([] { return false; }, start + FromSeconds(i / 30.0));
    ASSERT_TRUE(camera.Publish(publisher, i));
    for (int k = 0; k < 4; ++k) {
      dds::Message<idl::palpate_msgs::MarkerArray3> message;
      message->counter = static_cast<std::uint64_t>(4 * i + k);
      ASSERT_TRUE(markers.Write(message));
    }
    if (i % 30 == 0) memory_MiB = std::max(memory_MiB, recorder.Holds().memory_MiB);
  }
  ASSERT_TRUE(publisher.WaitUntilReceived(std::chrono::seconds(5)));
  recorder.Signal(SIGINT);
  const double cpu_s = recorder.CpuTime_s() - cpu_before_s;
  ASSERT_EQ(recorder.Wait(std::chrono::seconds(60)), 0) << ReadFile(folder / "log.txt");
  const double before_copy_s = ChildCpu_s();
  ASSERT_EQ(std::system(("cp " + file.string() + " " + (folder / "copy").string()).c_str()), 0);
  const double copy_s = ChildCpu_s() - before_copy_s;
  RecordProperty("cpu_percent", std::to_string(100.0 * cpu_s / 60.0));
  RecordProperty("copies", std::to_string(cpu_s / copy_s));
  RecordProperty("memory_MiB", std::to_string(memory_MiB));

  std::map<std::string, int> counts = CountsFrom(start_ns, file);
  EXPECT_EQ(counts["/camera/depth/image_raw"], kFrames);
  EXPECT_EQ(counts["/camera/color/image_raw"], kFrames);
  EXPECT_EQ(counts["/perception/markers"], 4 * kFrames);
  EXPECT_LE(100.0 * cpu_s / 60.0, 25.0);
  EXPECT_LE(memory_MiB, 200.0);
  EXPECT_LE(cpu_s, 3.0 * copy_s) << "the copy took " << copy_s << " s, recording " << cpu_s << " s";
}

TEST_F(RecorderLoad, RecordsFiveThousandSmallMessagesASecond) {
  const TestFolder folder;
  TestNode robot("robot");
  robot.loop.Every(std::chrono::milliseconds(5), [] {});
  // A writer that keeps what is on its way: those of the topic table keep the newest ten.
  dds::TopicSettings keeps;
  keeps.durability = dds::Durability::kTransientLocal;
  keeps.depth = 10'000;
  PlainWriter writer(robot, idl::MessageTraits<idl::std_msgs::Header>::Descriptor(), "rt/small",
                     keeps);
  Process recorder("palpate-recorder", {"--out", (folder / "run.mcap").string()},
                   folder / "log.txt");
  ASSERT_TRUE(robot.WaitFor([&] { return writer.is_read(); }));
  constexpr int kCount = 10'000;
  const dds::Message<idl::std_msgs::Header> small;
  const auto start = dds::WaitSet::Clock::now();
  for (int i = 0; i < kCount; ++i) {
    if (i % 50 == 0) {
      robot.loop.DispatchUntil([] { return false; }, start + FromSeconds(i / 5000.0));
    }
    ASSERT_TRUE(writer.Write(&*small));
  }
  ASSERT_TRUE(writer.WaitUntilReceived());
  recorder.Signal(SIGINT);
  ASSERT_EQ(recorder.Wait(std::chrono::seconds(20)), 0) << ReadFile(folder / "log.txt");
  EXPECT_EQ(TopicsIn(folder / "run.mcap").size(), static_cast<std::size_t>(kCount));
}

/// A file system of 8 MB in memory, mounted in a name space of the recorder alone.
TEST(RecorderOnFullDisk, SaysSoAtOnceAndLeavesAReadableFile) {
  const TestFolder folder;
  const std::string disk = (folder / "disk").string();
  std::filesystem::create_directory(disk);
  if (std::system("unshare -m true 2> /dev/null") != 0) GTEST_SKIP() << "may not mount (unshare)";
  TestNode robot("robot");
  robot.loop.Every(std::chrono::milliseconds(2), [] {});
  auto depth = robot.participant.CreateWriter(dds::kDepthImageTopic);
  const auto saved = folder / "saved.mcap";
  const std::string script = "mount -t tmpfs -o size=8m none " + disk +
                             " && { \"$@\"; code=$?; cp " + disk + "/run.mcap " + saved.string() +
                             "; exit $code; }";
  Process recorder("palpate-recorder", {"--out", disk + "/run.mcap"}, folder / "log.txt",
                   {"unshare", "-m", "bash", "-c", script, "bash"});
  ASSERT_TRUE(robot.WaitFor([&] { return depth.matched() > 0; })) << ReadFile(folder / "log.txt");
  dds::Message<idl::sensor_msgs::Image> image;
  dds::Resize(image->data, 800'000);
  const auto ended = [&] {
    EXPECT_TRUE(depth.Write(image));
    return std::filesystem::exists(saved);
  };
  ASSERT_TRUE(robot.WaitFor(ended)) << ReadFile(folder / "log.txt");
  EXPECT_EQ(recorder.Wait(std::chrono::seconds(20)), 1);
  EXPECT_THAT(ReadFile(folder / "log.txt"),
              HasSubstr("run.mcap: cannot be written: No space left on device"));
  EXPECT_GE(TopicsIn(saved).size(), 3u);
  EXPECT_TRUE(recording::Reader(saved).contents().indexed);
}

}  // namespace
}  // namespace palpate::recorder
