// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "components/capture/aravis/aravis_camera.hpp"
#include "components/capture/frame_source.hpp"
#include "components/capture/genicam/device_setup.hpp"
#include "components/capture/link/connection.hpp"
#include "components/capture/link/device_closer.hpp"
#include "components/capture/stream/frame_pool.hpp"

namespace palpate::capture {

struct LinkSettings {
  CameraTarget target;
  DeviceWishes wishes;
  StreamSettings stream;
  ConnectionTimes times;
  std::optional<double> depth_unit_m;
  std::size_t pool_frames = 8;
};

/// One camera, kept alive: opened, configured, streamed, monitored, and reopened whenever it comes
/// back, in a thread of its own. Decoded frames go to `on_frame`, in that thread; it must not wait.
class CameraLink {
 public:
  using OnFrame = std::function<void(std::shared_ptr<SourceFrame>)>;
  /// Called before the first frame of each epoch.
  using OnSetup = std::function<void(const DeviceSetup&, double depth_unit_m)>;

  CameraLink(LinkSettings settings, OnSetup on_setup, OnFrame on_frame);
  /// Waits until the camera is released: up to some seconds where it does not answer.
  ~CameraLink();
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;

  SourceHealth Health() const;

 private:
  struct OpenCamera;

  void Run();
  void Do(Step step);
  void Open();
  void Configure();
  void Stream(double timeout_s);
  void ProbeCamera();
  void Release();
  void Wait();
  void Deliver(FilledBuffer buffer);
  void FillFacts(const FilledBuffer& buffer, SourceFrame* frame);
  void CountFailure(const std::string& reason);
  void UpdateCounters();
  void PublishState();

  LinkSettings settings_;
  OnSetup on_setup_;
  OnFrame on_frame_;
  Connection connection_;
  FramePool pool_;
  DeviceCloser device_closer_;
  std::shared_ptr<OpenCamera> camera_;
  std::string known_address_;
  std::string known_id_;
  bool silent_ = false;  ///< the camera did not answer when it was last asked
  std::int64_t search_again_ns_ = 0;
  std::int64_t last_slow_look_ns_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable stopping_;
  bool stop_ = false;
  SourceHealth health_;
  std::thread thread_;
};

}  // namespace palpate::capture
