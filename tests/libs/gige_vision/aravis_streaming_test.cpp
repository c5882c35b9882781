// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstring>
#include <set>

#include "libs/core/clock.hpp"
#include "tests/libs/gige_vision/aravis_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

class AravisStreaming : public DeviceTest {
 protected:
  /// Which of the frames this part is, by its first pixel row; -1: none.
  template <typename Image>
  static int FrameOf(const void* data, std::size_t size, const std::vector<Image>& images) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      const auto& values = images[i].values;
      const bool same_size = size == values.size() * sizeof(values[0]);
      if (same_size && std::memcmp(data, values.data(), size) == 0) return static_cast<int>(i);
    }
    return -1;
  }

  static const void* Part(ArvBuffer* buffer, guint part, std::size_t* size) {
    return arv_buffer_get_part_data(buffer, part, size);
  }
};

std::vector<rgbd::DepthImage> DepthsOf(const std::vector<rgbd::RgbdFrame>& frames) {
  std::vector<rgbd::DepthImage> images;
  for (const auto& frame : frames) images.push_back(frame.depth);
  return images;
}

std::vector<rgbd::ColorImage> ColorsOf(const std::vector<rgbd::RgbdFrame>& frames) {
  std::vector<rgbd::ColorImage> images;
  for (const auto& frame : frames) images.push_back(frame.color);
  return images;
}

TEST_F(AravisStreaming, EveryPixelOfEveryPartArrives) {
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  const auto depths = DepthsOf(feeder.frames());
  const auto colors = ColorsOf(feeder.frames());
  AravisClient client(TestAddress());
  client.Start();
  std::set<int> seen;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(client.Next([&](ArvBuffer* buffer) {
      ASSERT_EQ(arv_buffer_get_payload_type(buffer), ARV_BUFFER_PAYLOAD_TYPE_MULTIPART);
      ASSERT_EQ(arv_buffer_get_n_parts(buffer), 3u);
      EXPECT_EQ(arv_buffer_get_part_component_id(buffer, 0), 4u);
      EXPECT_EQ(arv_buffer_get_part_component_id(buffer, 1), 1u);
      EXPECT_EQ(arv_buffer_get_part_component_id(buffer, 2), 6u);
      EXPECT_EQ(arv_buffer_get_part_data_type(buffer, 0), ARV_BUFFER_PART_DATA_TYPE_3D_IMAGE);
      EXPECT_EQ(arv_buffer_get_part_pixel_format(buffer, 0), ARV_PIXEL_FORMAT_COORD3D_C_16);
      EXPECT_EQ(arv_buffer_get_part_pixel_format(buffer, 1), ARV_PIXEL_FORMAT_RGB_8_PACKED);
      EXPECT_EQ(arv_buffer_get_part_width(buffer, 0), camera.depth.width_px);
      EXPECT_EQ(arv_buffer_get_part_height(buffer, 1), camera.color.height_px);
      std::size_t size = 0;
      const void* data = Part(buffer, 0, &size);
      const int number = FrameOf(data, size, depths);
      data = Part(buffer, 1, &size);
      EXPECT_NE(number, -1);
      EXPECT_EQ(FrameOf(data, size, colors), number);
      seen.insert(number);
      const auto* trust = static_cast<const std::uint8_t*>(Part(buffer, 2, &size));
      const auto& depth = depths[static_cast<std::size_t>(number)].values;
      ASSERT_EQ(size, depth.size());
      for (std::size_t k = 0; k < size; ++k) ASSERT_EQ(trust[k], depth[k] == 0 ? 0 : 255);
    }));
  }
  EXPECT_GT(seen.size(), 4u);
}

TEST_F(AravisStreaming, RangeAloneIsAnImage) {
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  const auto depths = DepthsOf(feeder.frames());
  for (const char* ids : {"On", "Off"}) {
    AravisClient client(TestAddress());
    client.Select("GevGVSPExtendedIDMode", ids);
    for (const char* component : {"Intensity", "Confidence"}) {
      client.Select("ComponentSelector", component);
      client.Set("ComponentEnable", std::int64_t{0});
    }
    client.Start();
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE(client.Next([&](ArvBuffer* buffer) {
        EXPECT_EQ(arv_buffer_get_payload_type(buffer), ARV_BUFFER_PAYLOAD_TYPE_IMAGE);
        EXPECT_EQ(arv_buffer_get_image_pixel_format(buffer), ARV_PIXEL_FORMAT_COORD3D_C_16);
        std::size_t size = 0;
        const void* data = arv_buffer_get_data(buffer, &size);
        EXPECT_NE(FrameOf(data, size, depths), -1);
      }));
    }
  }
}

TEST_F(AravisStreaming, WithoutPartsTheFirstComponentIsSent) {
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  AravisClient client(TestAddress());
  client.Set("GevSCCFGMultiPartEnabled", std::int64_t{0});
  client.Start();
  ASSERT_TRUE(client.Next([&](ArvBuffer* buffer) {
    EXPECT_EQ(arv_buffer_get_payload_type(buffer), ARV_BUFFER_PAYLOAD_TYPE_IMAGE);
    EXPECT_EQ(arv_buffer_get_image_width(buffer), camera.depth.width_px);
  }));
}

TEST_F(AravisStreaming, StampsAreThoseOfTheFrames) {
  MakeDevice();
  AravisClient client(TestAddress());
  client.Start();
  std::set<guint64> stamps_ns;
  bool arrived = false;
  for (int i = 0; i < 100 && !arrived; ++i) {  // on a busy machine one frame may be lost
    const std::int64_t stamp_ns = WallNow_ns() - 5'000'000;
    stamps_ns.insert(static_cast<guint64>(stamp_ns));
    device->Send(TestFrame(camera, 0, stamp_ns));
    const auto look = [&](ArvBuffer* buffer) {
      EXPECT_TRUE(stamps_ns.contains(arv_buffer_get_timestamp(buffer)));
    };
    arrived = client.Next(look, 0.3);
  }
  EXPECT_TRUE(arrived);
}

TEST_F(AravisStreaming, LossIsMendedByResends) {
  camera = TestCamera(320, 240);
  settings.impairment = {.loss = 0.05, .seed = 3};
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  const auto depths = DepthsOf(feeder.frames());
  const auto colors = ColorsOf(feeder.frames());
  AravisClient client(TestAddress());
  client.Start();
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(client.Next([&](ArvBuffer* buffer) {
      std::size_t size = 0;
      const void* data = Part(buffer, 0, &size);
      const int number = FrameOf(data, size, depths);
      EXPECT_NE(number, -1);
      data = Part(buffer, 1, &size);
      EXPECT_EQ(FrameOf(data, size, colors), number);
    }));
  }
  guint64 completed = 0;
  guint64 failed = 0;
  arv_stream_get_statistics(client.stream(), &completed, &failed, nullptr);
  EXPECT_LE(10 * failed,
            completed);  // without resends none would be complete; 0 on an idle machine
  EXPECT_GT(device->counters().packets_withheld, 100u);
  EXPECT_GT(device->counters().packets_resent, 100u);
}

TEST_F(AravisStreaming, StopAndStartAgain) {
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  AravisClient client(TestAddress());
  for (int i = 0; i < 3; ++i) {
    client.Start();
    EXPECT_TRUE(client.Next([](ArvBuffer*) {}));
    client.Stop();
    EXPECT_TRUE(WaitUntil([&] { return !device->streaming(); }));
  }
}

TEST_F(AravisStreaming, DeviceThatReturnsStreamsToANewClient) {
  MakeDevice();
  for (int i = 0; i < 2; ++i) {
    FrameFeeder feeder(device.get(), camera);
    AravisClient client(TestAddress());
    client.Start();
    EXPECT_TRUE(client.Next([](ArvBuffer*) {}));
    client.Stop();
  }
  device.reset();
  MakeDevice();
  FrameFeeder feeder(device.get(), camera);
  AravisClient client(TestAddress());
  client.Start();
  EXPECT_TRUE(client.Next([](ArvBuffer*) {}));
}

}  // namespace
}  // namespace palpate::gige_vision
