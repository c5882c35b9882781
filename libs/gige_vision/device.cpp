// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/device.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <thread>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/gige_vision/camera_state.hpp"
#include "libs/gige_vision/control_channel.hpp"
#include "libs/gige_vision/stream_sender.hpp"
#include "libs/gige_vision/udp_socket.hpp"

namespace palpate::gige_vision {
namespace {

constexpr std::uint32_t kEverywhere = 0xffff'ffff;     // 255.255.255.255
constexpr std::uint64_t kLocalMac = 0x0200'0000'0000;  // of no manufacturer
constexpr int kMostPackets = 64;                       // answered before the clock is read again

/// The same serial number at the same address has the same MAC address (FNV-1a).
std::uint64_t MacOf(const std::string& serial, std::uint32_t address) {
  std::uint64_t hash = 0xcbf2'9ce4'8422'2325 ^ address;
  for (const char c : serial) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100'0000'01b3;
  return kLocalMac | (hash & 0xff'ffff'ffff);
}

void CheckSettings(const DeviceSettings& settings, const rgbd::RgbdCamera& camera) {
  const Impairment& impairment = settings.impairment;
  if (!(settings.rate_hz > 0.0)) throw InputError("rate_hz must be positive");
  if (!(impairment.loss >= 0.0 && impairment.loss <= 1.0) || !(impairment.resend_loss <= 1.0)) {
    throw InputError("loss must be in [0, 1]");
  }
  if (camera.depth.width_px < 16 || camera.depth.height_px < 16) {
    throw InputError("a camera of less than 16 x 16 px");
  }
}

}  // namespace

struct Device::Parts {
  Parts(const DeviceSettings& settings, const rgbd::RgbdCamera& its_camera)
      : camera{its_camera}, interface {
    FindInterface(settings.interface_address)
  }, own_socket{interface.address, kControlPort, false},
      everywhere{kEverywhere, kControlPort, true},
      sender{interface, settings.rate_hz, settings.impairment},
      state{settings, its_camera,
            Identity{interface.address, interface.mask, MacOf(settings.serial, interface.address),
                     sender.source_port()},
            WallNow_ns},
      control{&state} {
    if (interface.Broadcast() != interface.address) {
      subnet = std::make_unique<UdpSocket>(interface.Broadcast(), kControlPort, true);
    }
    state.on_stream_channel = [this](bool) { sender.Reset(); };
    state.on_test_packet = [this](const StreamPlan& plan) { tests.push_back(plan); };
    control.on_resend = [this](const ResendRequest& asked) { resends.push_back(asked); };
    wake = eventfd(0, EFD_CLOEXEC);
    if (wake < 0) throw RunError("cannot make an event descriptor");
    thread = std::thread([this] { Run(); });
  }

  ~Parts() {
    const std::uint64_t one = 1;
    PALPATE_CHECK(write(wake, &one, sizeof one) == sizeof one);
    thread.join();
    close(wake);
  }

  void Run() {
    std::vector<pollfd> watched = {{wake, POLLIN, 0}};
    std::vector<const UdpSocket*> sockets = {&own_socket, &everywhere};
    if (subnet) sockets.push_back(subnet.get());
    for (const UdpSocket* socket : sockets) watched.push_back({socket->descriptor(), POLLIN, 0});
    while (true) {
      poll(watched.data(), watched.size(), Patience_ms());
      if ((watched[0].revents & POLLIN) != 0) return;
      for (const UdpSocket* socket : sockets) AnswerAll(*socket);
      const std::lock_guard lock(mutex);
      control.CheckHeartbeat(MonotonicNow_ns());
    }
  }

  int Patience_ms() {
    const std::lock_guard lock(mutex);
    const auto deadline_ns = control.Deadline_ns();
    if (!deadline_ns) return -1;
    const std::int64_t left_ms = (*deadline_ns - MonotonicNow_ns()) / 1'000'000 + 1;
    return static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, 60'000));
  }

  void AnswerAll(const UdpSocket& socket) {
    for (int i = 0; i < kMostPackets; ++i) {
      const auto received = socket.Receive();
      if (!received) return;
      const bool broadcast = &socket != &own_socket;
      if (broadcast && received->interface_index != interface.index) continue;
      Bytes answer;
      {
        const std::lock_guard lock(mutex);
        answer = control.Answer(received->packet, received->from, MonotonicNow_ns());
      }
      // Outside of the lock, which Send needs.
      for (const StreamPlan& plan : std::exchange(tests, {})) sender.SendTest(plan);
      for (const ResendRequest& asked : std::exchange(resends, {})) sender.Resend(asked);
      if (!answer.empty()) own_socket.Send(answer, received->from);
    }
  }

  const rgbd::RgbdCamera camera;
  const Interface interface;
  UdpSocket own_socket;
  UdpSocket everywhere;               ///< discovery
  std::unique_ptr<UdpSocket> subnet;  ///< discovery
  std::mutex mutex;                   ///< of state and control
  std::mutex send_mutex;              ///< of those who call Send
  StreamSender sender;
  CameraState state;
  ControlChannel control;
  std::vector<StreamPlan> tests;       ///< of the thread alone
  std::vector<ResendRequest> resends;  ///< of the thread alone
  int wake = -1;
  std::thread thread;
};

Device::Device(const DeviceSettings& settings, const rgbd::RgbdCamera& camera) {
  CheckSettings(settings, camera);
  parts_ = std::make_unique<Parts>(settings, camera);
}

Device::~Device() = default;

bool Device::streaming() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->state.Plan().has_value();
}

void Device::Send(const rgbd::RgbdFrame& frame) {
  const rgbd::RgbdCamera& camera = parts_->camera;
  PALPATE_CHECK(frame.depth.width_px == camera.depth.width_px &&
                frame.depth.height_px == camera.depth.height_px);
  PALPATE_CHECK(frame.color.empty() || (frame.color.width_px == camera.color.width_px &&
                                        frame.color.height_px == camera.color.height_px));
  const std::lock_guard one_at_a_time(parts_->send_mutex);
  std::optional<StreamPlan> plan;
  std::optional<StreamSender::Ticket> ticket;
  std::uint64_t timestamp_ns = 0;
  {
    const std::lock_guard lock(parts_->mutex);
    plan = parts_->state.Plan();
    if (!plan) return;
    ticket = parts_->sender.Ask();
    if (!ticket || !parts_->state.TakeFrame()) return;
    timestamp_ns = parts_->state.Timestamp_ns(frame.stamp_ns);
  }
  parts_->sender.Offer(*ticket, *plan, frame, timestamp_ns);
}

DeviceCounters Device::counters() const { return parts_->sender.counters(); }

std::string Device::Describe() const { return parts_->state.description(); }

}  // namespace palpate::gige_vision
