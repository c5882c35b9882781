// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/clock.hpp"
#include "tests/components/palpate/security/secured_domain.hpp"

namespace palpate::command {
namespace {

constexpr std::size_t kImageBytes = 2'000'000;
constexpr int kImages = 90;
constexpr std::chrono::milliseconds kPeriod{33};

struct Measured {
  double received = 0.0;   ///< of kImages
  double median_ms = 0.0;  ///< from before the write to the arrival
  double write_ms = 0.0;   ///< median time in the write
  double cpu_ms = 0.0;     ///< processor time of both ends for an image
  double rate_hz = 0.0;    ///< of images sent one after the other, without a pause
};

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A camera and a viewer of its images.
class ImageStream {
 public:
  ImageStream(const dds::SecuritySettings& camera, const dds::SecuritySettings& viewer)
      : camera_("camera", camera), viewer_("viewer", viewer) {
    dds::Resize(image_->data, kImageBytes);
    std::memset(image_->data._buffer, 7, kImageBytes);
    viewer_.loop.Attach(reader_, [this] {
      for (const auto& image : reader_.Take()) {
        std::int64_t sent_ns = 0;
        std::memcpy(&sent_ns, image.data._buffer, sizeof(sent_ns));
        latencies_ms_.push_back(1e-6 * static_cast<double>(MonotonicNow_ns() - sent_ns));
        ++received_;
      }
    });
    thread_ = std::thread([this] { viewer_.loop.Run(); });
  }
  ~ImageStream() {
    viewer_.loop.Stop();
    thread_.join();
  }
  ImageStream(const ImageStream&) = delete;
  ImageStream& operator=(const ImageStream&) = delete;

  Measured Measure() {
    const auto end = dds::WaitSet::Clock::now() + std::chrono::seconds(20);
    EXPECT_TRUE(camera_.loop.DispatchUntil([&] { return writer_.matched() == 1; }, end));
    Measured measured;
    std::vector<double> writes_ms;
    const std::clock_t cpu_begin = std::clock();
    auto turn = std::chrono::steady_clock::now();
    for (int i = 0; i < kImages; ++i, turn += kPeriod) {
      std::this_thread::sleep_until(turn);  // the camera's rate
      writes_ms.push_back(Send());
    }
    measured.cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu_begin) /
                      (static_cast<double>(CLOCKS_PER_SEC) * kImages);
    AwaitAll(kImages);
    measured.received = received_;
    measured.median_ms = MedianOf(latencies_ms_);
    measured.write_ms = MedianOf(writes_ms);
    const std::int64_t begin_ns = MonotonicNow_ns();
    for (int i = 0; i < kImages; ++i) {
      const int before = received_;
      Send();
      AwaitAll(before + 1);
    }
    measured.rate_hz = 1e9 * kImages / static_cast<double>(MonotonicNow_ns() - begin_ns);
    return measured;
  }

 private:
  double Send() {
    const std::int64_t now_ns = MonotonicNow_ns();
    std::memcpy(image_->data._buffer, &now_ns, sizeof(now_ns));
    EXPECT_TRUE(writer_.Write(image_));
    return 1e-6 * static_cast<double>(MonotonicNow_ns() - now_ns);
  }
  void AwaitAll(int count) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (received_ < count && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }

  NetworkNode camera_;
  NetworkNode viewer_;
  dds::Message<idl::sensor_msgs::Image> image_;
  dds::Writer<idl::sensor_msgs::Image> writer_ =
      camera_.participant.CreateWriter(dds::kDepthImageTopic, camera_.Waker());
  dds::Reader<idl::sensor_msgs::Image> reader_ =
      viewer_.participant.CreateReader(dds::kDepthImageTopic);
  std::vector<double> latencies_ms_;
  std::atomic<int> received_ = 0;
  std::thread thread_;
};

/// Plain and secured by turns, so that both meet the same machine.
TEST(SecurityCost, OfImagesIsAFewTimesThatOfPlainOnesAtMost) {
  const test_support::TestFolder folder;
  const SeparateDomains domains;
  const auto keystore = MakeKeystore(folder, "keystore", {"capture", "observer"});
  std::vector<Measured> plain;
  std::vector<Measured> secured;
  for (int round = 0; round < 3; ++round) {
    plain.push_back(ImageStream({}, {}).Measure());
    secured.push_back(ImageStream({keystore, "capture"}, {keystore, "observer"}).Measure());
  }
  const auto median = [](const std::vector<Measured>& rounds, double Measured::*value) {
    std::vector<double> values;
    for (const Measured& round : rounds) values.push_back(round.*value);
    return MedianOf(values);
  };
  for (const auto& [name, value] : {std::pair{"received of 90", &Measured::received},
                                    std::pair{"latency at 30 Hz, ms", &Measured::median_ms},
                                    std::pair{"time in the write, ms", &Measured::write_ms},
                                    std::pair{"processor time, ms", &Measured::cpu_ms},
                                    std::pair{"one after the other, Hz", &Measured::rate_hz}}) {
    const double before = median(plain, value);
    const double after = median(secured, value);
    fmt::print("{:<24} plain {:8.2f} secured {:8.2f} ratio {:.2f}\n", name, before, after,
               after / before);
  }
  for (const Measured& round : secured) EXPECT_GT(round.received, 0.0);
  // Encrypting fragment by fragment would take ten times the processor time of plain images.
  EXPECT_LT(median(secured, &Measured::cpu_ms), 5.0 * median(plain, &Measured::cpu_ms));
}

}  // namespace
}  // namespace palpate::command
