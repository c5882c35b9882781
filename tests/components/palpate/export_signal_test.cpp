// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <random>
#include <thread>

#include "libs/app/child_process.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/recordings/topic_recording.hpp"
#include "tests/components/palpate/test_robot.hpp"

/// `palpate export --experiment` leaves a whole experiment or none.
namespace palpate::command {
namespace {

class ExportOfAnExperiment : public testing::Test {
 protected:
  /// Of images that take some time to be packed.
  void WriteRecording(int images, bool with_info) {
    constexpr std::uint32_t kWidth = 640;
    constexpr std::uint32_t kHeight = 480;
    TopicRecording messages;
    if (with_info) {
      messages.Add("/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", kStart_ns,
                   CameraInfoMessage("camera", kWidth, kHeight));
    }
    std::mt19937 random(1);
    std::vector<std::uint8_t> depth(std::size_t{2} * kWidth * kHeight);
    for (std::uint8_t& byte : depth) byte = static_cast<std::uint8_t>(random());
    for (int i = 0; i < images; ++i) {
      const std::int64_t t_ns = kStart_ns + i * kStep_ns;
      messages.Add("/camera/depth/image_raw", "sensor_msgs/msg/Image", t_ns,
                   ImageMessage(t_ns, "camera", kWidth, kHeight, "16UC1", 2 * kWidth, depth));
    }
    messages.WriteMcap(folder_ / "run.mcap");
  }

  app::ChildProcess Export() {
    return {PALPATE_BINARY_DIR "/bin/palpate",
            {"export", (folder_ / "run.mcap").string(), "--experiment", out_.string()},
            {},
            folder_ / "log"};
  }

  const TestFolder folder_;
  const std::filesystem::path out_ = folder_ / "out";
};

TEST_F(ExportOfAnExperiment, LeavesNoFolderWhereItFails) {
  WriteRecording(1, false);
  app::ChildProcess process = Export();
  EXPECT_EQ(process.Wait(), app::kExitUsage);
  EXPECT_THAT(ReadFile(folder_ / "log"), testing::HasSubstr("no intrinsics"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(ExportOfAnExperiment, LeavesNoFolderWhereItIsInterrupted) {
  WriteRecording(200, true);
  app::ChildProcess process = Export();
  while (!std::filesystem::exists(out_ / "recordings") && !process.ExitCode()) {
    std::this_thread::yield();
  }
  process.Interrupt();
  EXPECT_EQ(process.Wait(), app::kExitInterrupted);
  EXPECT_THAT(ReadFile(folder_ / "log"), testing::HasSubstr("interrupted: " + out_.string()));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace palpate::command
