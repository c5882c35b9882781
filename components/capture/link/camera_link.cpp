// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/camera_link.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "components/capture/clock/device_clock.hpp"
#include "components/capture/link/frame_decoder.hpp"
#include "components/capture/network/control_probe.hpp"
#include "components/capture/network/packet_size.hpp"
#include "components/capture/network/socket_report.hpp"
#include "libs/core/clock.hpp"

namespace palpate::capture {

namespace {

constexpr double kFrameWait_s = 0.05;
constexpr double kProbeTime_s = 0.1;
constexpr std::int64_t kSlowLook_ns = 500'000'000;
constexpr std::int64_t kSearchAgain_ns = 15'000'000'000;  ///< it may have got another address

}  // namespace

/// Everything that belongs to one opening of the device; members go in reverse order.
struct CameraLink::OpenCamera {
  std::unique_ptr<AravisCamera> device;
  DeviceSetup setup;
  std::unique_ptr<FrameDecoder> decoder;
  std::unique_ptr<DeviceClock> clock;
  StreamCounters counted;  ///< at the last frame
  std::uint64_t socket_drops = 0;
};

CameraLink::CameraLink(LinkSettings settings, OnSetup on_setup, OnFrame on_frame)
    : settings_(std::move(settings)),
      on_setup_(std::move(on_setup)),
      on_frame_(std::move(on_frame)),
      connection_(settings_.times),
      pool_(settings_.pool_frames) {
  health_.device = settings_.target.id;
  health_.reason = connection_.reason();
  thread_ = std::thread([this] { Run(); });
}

CameraLink::~CameraLink() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  thread_.join();
}

SourceHealth CameraLink::Health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

void CameraLink::Run() {
  while (true) {
    {
      const std::lock_guard lock(mutex_);
      if (stop_) break;
    }
    Do(connection_.Next(MonotonicNow_ns()));
    PublishState();
  }
  Release();
}

void CameraLink::Do(Step step) {
  switch (step) {
    case Step::kOpen: return Open();
    case Step::kConfigure: return Configure();
    case Step::kStream: return Stream(kFrameWait_s);
    case Step::kProbe: return ProbeCamera();
    case Step::kRelease: return Release();
    case Step::kWait: return Wait();
  }
}

void CameraLink::Open() {
  PublishState();
  std::string reason;
  const std::int64_t now_ns = MonotonicNow_ns();
  // A camera that was seen is asked at its address, which is quick; after a while it is searched.
  if (search_again_ns_ == 0) search_again_ns_ = now_ns + kSearchAgain_ns;
  const bool search = known_address_.empty() || now_ns > search_again_ns_;
  if (search) search_again_ns_ = now_ns + kSearchAgain_ns;
  auto device = AravisCamera::Open(settings_.target, search ? "" : known_address_, &reason);
  if (!device) return connection_.OnFailed(MonotonicNow_ns(), std::move(reason));
  if (!known_id_.empty() && device->id() != known_id_) {
    device_closer_.Take(std::shared_ptr<AravisCamera>(std::move(device)));
    return connection_.OnFailed(MonotonicNow_ns(), "another camera answers at " + known_address_);
  }
  known_address_ = device->address();
  known_id_ = device->id();
  camera_ = std::make_shared<OpenCamera>();
  camera_->device = std::move(device);
  {
    const std::lock_guard lock(mutex_);
    health_.device = camera_->device->id();
    health_.model = camera_->device->model();
  }
  connection_.OnOpened(MonotonicNow_ns());
}

void CameraLink::Configure() {
  AravisCamera& device = *camera_->device;
  if (!device.TakeControl()) return connection_.OnAccessDenied(MonotonicNow_ns());
  camera_->setup = ConfigureDevice(device.features(), settings_.wishes);
  DeviceSetup& setup = camera_->setup;
  if (!setup.status.ok()) {
    return connection_.OnFailed(MonotonicNow_ns(), setup.status.message());
  }
  const bool large_packets_fail = connection_.fruitless_streams() % 2 == 1;
  const Status started =
      device.Start(settings_.stream, large_packets_fail ? kSafePacketSize_bytes : 0);
  if (!started.ok()) return connection_.OnFailed(MonotonicNow_ns(), started.message());
  camera_->decoder = std::make_unique<FrameDecoder>(setup, settings_.depth_unit_m);
  camera_->clock = std::make_unique<DeviceClock>(device.features());
  const auto granted = GrantedReceiveBuffer_bytes(settings_.stream.socket_buffer_bytes);
  const std::string advice =
      device.port() == 0
          ? ""
          : ReceiveBufferAdvice(settings_.stream.socket_buffer_bytes, granted.value_or(0));
  if (!advice.empty()) setup.notes.push_back(advice);
  if (device.port() != 0 && !device.guarded()) {
    setup.notes.push_back("the kernel does not keep strangers' packets away from the stream");
  }
  {
    const std::lock_guard lock(mutex_);
    health_.notes = setup.notes;
  }
  search_again_ns_ = 0;
  connection_.OnConfigured(MonotonicNow_ns(), setup.period_s);
  on_setup_(setup, camera_->decoder->depth_unit_m());
}

void CameraLink::Stream(double timeout_s) {
  if (camera_->device->control_lost()) return connection_.OnControlLost(MonotonicNow_ns());
  auto buffer = camera_->device->Pop(timeout_s);
  if (buffer) Deliver(std::move(*buffer));
  if (MonotonicNow_ns() - last_slow_look_ns_ > kSlowLook_ns) UpdateCounters();
}

void CameraLink::Deliver(FilledBuffer buffer) {
  if (!buffer.complete()) return CountFailure("frames come incomplete");
  const auto frame = pool_.Take();
  if (!frame) {
    const std::lock_guard lock(mutex_);
    ++health_.frames_dropped;
    return;
  }
  const Status decoded =
      camera_->decoder->Decode(buffer.ReadParts(camera_->setup.codes), frame.get());
  if (!decoded.ok()) return CountFailure(decoded.message());
  FillFacts(buffer, frame.get());
  connection_.OnFrame(MonotonicNow_ns());
  {
    const std::lock_guard lock(mutex_);
    ++health_.frames;
  }
  on_frame_(frame);
}

void CameraLink::FillFacts(const FilledBuffer& buffer, SourceFrame* frame) {
  FrameFacts& facts = frame->facts;
  facts.frame_id = buffer.frame_id();
  facts.epoch = connection_.epoch();
  facts.stamp_receive_ns = WallNow_ns();
  facts.stamp_device_ns = buffer.stamp_device_ns();
  const auto host_ns =
      facts.stamp_device_ns > 0 ? camera_->clock->ToHost_ns(facts.stamp_device_ns) : std::nullopt;
  facts.clock_source = host_ns ? camera_->clock->source() : ClockSource::kHostReceive;
  facts.stamp_host_ns = host_ns.value_or(facts.stamp_receive_ns);
  frame->images.stamp_ns = facts.stamp_host_ns;
  facts.exposure_s = camera_->setup.exposure_s;
  facts.gain_dB = camera_->setup.gain_dB;
  facts.temperature_degC = camera_->clock->temperature_degC();
  const StreamCounters before = std::exchange(camera_->counted, camera_->device->counters());
  facts.packets_lost = camera_->counted.packets_lost - before.packets_lost;
  facts.packets_resent = camera_->counted.packets_resent - before.packets_resent;
  const std::lock_guard lock(mutex_);
  health_.packets_lost += facts.packets_lost;
  health_.packets_resent += facts.packets_resent;
  health_.frames_dropped += camera_->counted.underruns - before.underruns;
}

void CameraLink::CountFailure(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++health_.frames_failed;
  health_.last_failure = reason;
}

void CameraLink::UpdateCounters() {
  last_slow_look_ns_ = MonotonicNow_ns();
  const int port = camera_ ? camera_->device->port() : 0;
  const auto drops = port > 0 ? SocketDrops(port) : std::nullopt;
  if (!drops || *drops < camera_->socket_drops) return;
  const std::lock_guard lock(mutex_);
  health_.socket_drops += *drops - std::exchange(camera_->socket_drops, *drops);
}

void CameraLink::ProbeCamera() {
  Stream(kFrameWait_s);
  if (connection_.state() != SourceState::kStale) return;
  if (camera_->device->address().empty()) return;
  const Probe probe = ProbeControl(camera_->device->address(), kProbeTime_s);
  silent_ = probe == Probe::kSilent;
  connection_.OnProbe(MonotonicNow_ns(), probe);
}

void CameraLink::Release() {
  if (camera_) device_closer_.Take(std::exchange(camera_, nullptr));
}

void CameraLink::Wait() {
  const std::int64_t left_ns = connection_.wake_ns() - MonotonicNow_ns();
  const auto step =
      std::chrono::nanoseconds(std::clamp<std::int64_t>(left_ns, 1'000'000, 100'000'000));
  {
    std::unique_lock lock(mutex_);
    if (stopping_.wait_for(lock, step, [this] { return stop_; })) return;
  }
  if (connection_.state() != SourceState::kDiscover || known_address_.empty()) return;
  const bool silent = ProbeControl(known_address_, kProbeTime_s) == Probe::kSilent;
  if (std::exchange(silent_, silent) && !silent) connection_.OnReturn(MonotonicNow_ns());
}

void CameraLink::PublishState() {
  const std::lock_guard lock(mutex_);
  health_.state = connection_.state();
  health_.reason = connection_.reason();
  health_.epoch = connection_.epoch();
}

}  // namespace palpate::capture
