// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// gige_vision_rate [SECONDS [LOSS [PACKET_SIZE [ADDRESS]]]]: streams 848x480 depth + colour at 30
// Hz from a device in a process of its own to Aravis in this one, and prints what came and what it
// cost.

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/clock.hpp"
#include "libs/gige_vision/device.hpp"
#include "tests/libs/gige_vision/aravis_client.hpp"

namespace palpate::gige_vision {
namespace {

struct Options {
  double seconds = 10.0;
  double loss = 0.0;
  std::int64_t packet_size = 1500;
  std::string address = "127.70.0.1";
};

rgbd::RgbdCamera Camera() {
  rgbd::RgbdCamera camera;
  camera.depth = {848, 480, 665.0, 665.0, 423.5, 239.5, {}};
  camera.color = camera.depth;
  return camera;
}

[[noreturn]] void ServeForEver(const Options& options) {
  DeviceSettings settings;
  settings.interface_address = options.address;
  settings.impairment.loss = options.loss;
  const rgbd::RgbdCamera camera = Camera();
  Device device(settings, camera);
  rgbd::RgbdFrame frame;
  frame.depth = rgbd::DepthImage(camera.depth.width_px, camera.depth.height_px, 4500);
  frame.color = rgbd::ColorImage(camera.color.width_px, camera.color.height_px, 90);
  auto next = std::chrono::steady_clock::now();
  while (true) {
    frame.stamp_ns = WallNow_ns();
    device.Send(frame);
    next += std::chrono::nanoseconds(33'333'333);
    std::this_thread::sleep_until(next);
  }
}

double CpuSeconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void Measure(const Options& options) {
  AravisClient client(options.address);
  client.Set("GevSCPSPacketSize", options.packet_size);
  client.Start(16);
  client.Next([](ArvBuffer*) {});
  const double cpu_s = CpuSeconds(RUSAGE_SELF);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  int frames = 0;
  std::vector<double> latencies_ms;
  while (elapsed_s() < options.seconds) {
    frames += client.Next([&](ArvBuffer* buffer) {
      const auto stamp_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer));
      latencies_ms.push_back(1e-6 * static_cast<double>(WallNow_ns() - stamp_ns));
    });
  }
  const double took_s = elapsed_s();
  guint64 completed = 0;
  guint64 failed = 0;
  guint64 underruns = 0;
  arv_stream_get_statistics(client.stream(), &completed, &failed, &underruns);
  std::printf("%.2f fps, %llu failed, latency median %.1f ms, 99 %% %.1f ms, client %.1f %% CPU\n",
              frames / took_s, static_cast<unsigned long long>(failed),
              Percentile(latencies_ms, 0.5), Percentile(latencies_ms, 0.99),
              100.0 * (CpuSeconds(RUSAGE_SELF) - cpu_s) / took_s);
}

int Main(int argc, char** argv) {
  Options options;
  if (argc > 1) options.seconds = std::stod(argv[1]);
  if (argc > 2) options.loss = std::stod(argv[2]);
  if (argc > 3) options.packet_size = std::stoll(argv[3]);
  if (argc > 4) options.address = argv[4];
  const auto begin = std::chrono::steady_clock::now();
  const pid_t device = fork();
  if (device == 0) ServeForEver(options);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  int result = 0;
  try {
    Measure(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    result = 1;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  kill(device, SIGKILL);
  waitpid(device, nullptr, 0);
  std::printf("device %.1f %% CPU\n", 100.0 * CpuSeconds(RUSAGE_CHILDREN) / took.count());
  return result;
}

}  // namespace
}  // namespace palpate::gige_vision

int main(int argc, char** argv) { return palpate::gige_vision::Main(argc, argv); }
