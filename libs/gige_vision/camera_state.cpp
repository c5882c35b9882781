// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/camera_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "libs/gige_vision/camera_features.hpp"
#include "libs/gige_vision/description.hpp"

namespace palpate::gige_vision {
namespace {

constexpr std::uint32_t kFirstFeature = 0x0001'0000;
constexpr std::uint32_t kDescription = 0x0020'0000;
constexpr std::uint64_t kTicksPerSecond = 1'000'000'000;
constexpr std::int64_t kTaiFromUtc_ns = 37'000'000'000;  // since 2017: what PTP says
constexpr std::uint32_t kPtpDisabled = 3;
constexpr std::uint32_t kPtpSlave = 9;
enum AcquisitionMode : std::uint32_t { kContinuous = 0, kSingleFrame = 1, kMultiFrame = 2 };

}  // namespace

CameraState::CameraState(const DeviceSettings& settings, const rgbd::RgbdCamera& camera,
                         const Identity& identity, Clock wall_clock)
    : wall_clock_{std::move(wall_clock)},
      components_{Components(settings, camera)},
      identity_{identity},
      rate_hz_{settings.rate_hz},
      invalid_depth_{static_cast<std::uint16_t>(camera.invalid_value)} {
  started_ns_ = wall_clock_();
  FeatureTable features = CameraFeatures(settings, camera);
  for (Feature& feature : TransportFeatures()) features.push_back(std::move(feature));
  AssignAddresses(&features, kFirstFeature);
  AddRegisters(features, &bank_);
  AddInterface();
  AddControl(settings.heartbeat_timeout_s);
  AddChannels();
  AddNames(settings);
  description_ = DescribeFeatures(features, settings.vendor, settings.model);
  AddDescription(settings.faults.edit_xml ? settings.faults.edit_xml(description_) : description_);
  WireAcquisition();
  WireClock();
  WireStreamChannel();
  WireRegions();
  if (settings.faults.edit_value) bank_.set_falsifier(settings.faults.edit_value);
}

void CameraState::AddBootstrap(const std::vector<BootstrapLine>& lines) {
  for (const BootstrapLine& line : lines) {
    bank_.Add({line.name, line.address, line.writable, {}, {}, {Encode32(line.value)}});
  }
}

void CameraState::AddInterface() {
  AddBootstrap({
      {"Version", boot::kVersion, 0x0002'0000},
      {"DeviceMode", boot::kDeviceMode, 0x8000'0001},  // big-endian transmitter, UTF-8
      {"MacHigh", boot::kMacHigh, static_cast<std::uint32_t>(identity_.mac >> 32)},
      {"MacLow", boot::kMacLow, static_cast<std::uint32_t>(identity_.mac)},
      {"InterfaceCapability", boot::kInterfaceCapability, 0x7},  // LLA, DHCP, persistent
      {"InterfaceConfiguration", boot::kInterfaceConfiguration, 0x5, true},
      {"CurrentIp", boot::kCurrentIp, identity_.address},
      {"CurrentMask", boot::kCurrentMask, identity_.mask},
      {"CurrentGateway", boot::kCurrentGateway, 0},
      {"InterfaceCount", boot::kInterfaceCount, 1},
      {"PersistentIp", boot::kPersistentIp, identity_.address, true},
      {"PersistentMask", boot::kPersistentMask, identity_.mask, true},
      {"PersistentGateway", boot::kPersistentGateway, 0, true},
      {"LinkSpeed", boot::kLinkSpeed, 1000},
      {"ActiveLinkCount", boot::kActiveLinkCount, 1},
      {"LinkConfigurationCapability", boot::kLinkConfigurationCapability, 1},
      {"LinkConfiguration", boot::kLinkConfiguration, 0},
  });
}

void CameraState::AddControl(double heartbeat_timeout_s) {
  const double timeout_ms =
      std::clamp(heartbeat_timeout_s * 1e3, static_cast<double>(kMinHeartbeatTimeout_ms),
                 static_cast<double>(kMaxHeartbeatTimeout_ms));
  AddBootstrap({
      {"ControlCapability", boot::kControlCapability, kControlCapabilities},
      {"HeartbeatTimeout", boot::kHeartbeatTimeout, static_cast<std::uint32_t>(timeout_ms), true},
      {"TickFrequencyHigh", boot::kTickFrequencyHigh, kTicksPerSecond >> 32},
      {"TickFrequencyLow", boot::kTickFrequencyLow, kTicksPerSecond & 0xffff'ffff},
      {"TimestampControl", boot::kTimestampControl, 0, true},
      {"TimestampHigh", boot::kTimestampHigh, 0},
      {"TimestampLow", boot::kTimestampLow, 0},
      {"ControlConfiguration", boot::kControlConfiguration, 0, true},
      {"PendingTimeout", boot::kPendingTimeout, 100},
      {"ControlPrivilege", boot::kControlPrivilege, 0, true},
      {"PrimaryPort", boot::kPrimaryPort, 0},
      {"PrimaryAddress", boot::kPrimaryAddress, 0},
  });
}

void CameraState::AddChannels() {
  AddBootstrap({
      {"MessageChannelCount", boot::kMessageChannelCount, 1},
      {"StreamChannelCount", boot::kStreamChannelCount, 1},
      {"StreamCapability", boot::kStreamCapability, 0xc000'0000},    // source port, 16-bit ids
      {"MessageCapability", boot::kMessageCapability, 0x8000'0000},  // source port
      {"StreamConfiguration", boot::kStreamConfiguration, kExtendedIdEnable, true},
      {"MessagePort", boot::kMessagePort, 0, true},
      {"MessageAddress", boot::kMessageAddress, 0, true},
      {"MessageTimeout", boot::kMessageTimeout, 1000, true},
      {"MessageRetries", boot::kMessageRetries, 3, true},
      {"MessageSourcePort", boot::kMessageSourcePort, kControlPort},
      {"StreamPort", boot::kStreamPort, 0, true},
      {"StreamPacketSize", boot::kStreamPacketSize, kDoNotFragment | 1500, true},
      {"StreamPacketDelay", boot::kStreamPacketDelay, 0, true},
      {"StreamAddress", boot::kStreamAddress, 0, true},
      {"StreamSourcePort", boot::kStreamSourcePort, identity_.stream_source_port},
      {"StreamChannelCapability", boot::kStreamChannelCapability, kMultipartEnable},
      {"StreamChannelConfiguration", boot::kStreamChannelConfiguration, kMultipartEnable, true},
  });
}

void CameraState::AddNames(const DeviceSettings& settings) {
  const auto add = [&](const char* name, std::uint32_t address, std::size_t size,
                       const std::string& text, bool writable) {
    bank_.Add({name, address, writable, {}, {}, {EncodeText(text, size)}});
  };
  add("Manufacturer", boot::kManufacturer, 32, settings.vendor, false);
  add("Model", boot::kModel, 32, settings.model, false);
  add("DeviceVersionText", boot::kDeviceVersion, 32, "1.0", false);
  add("ManufacturerInfo", boot::kManufacturerInfo, 48, "A virtual camera: no light, no lens",
      false);
  add("Serial", boot::kSerial, 16, settings.serial, false);
  add("UserName", boot::kUserName, 16, settings.user_name, true);
}

void CameraState::AddDescription(const std::string& text) {
  Bytes bytes(text.begin(), text.end());
  while (bytes.empty() || bytes.size() % 4 != 0) bytes.push_back('\n');
  std::array<char, 80> url{};
  std::snprintf(url.data(), url.size(), "Local:palpate_virtual_rgbd.xml;%X;%zX",
                static_cast<unsigned>(kDescription), bytes.size());
  bank_.Add({"FirstUrl", boot::kFirstUrl, false, {}, {}, {EncodeText(url.data(), 512)}});
  bank_.Add({"SecondUrl", boot::kSecondUrl, false, {}, {}, {Bytes(512)}});
  bank_.Add({"Description", kDescription, false, {}, {}, {std::move(bytes)}});
}

void CameraState::WireAcquisition() {
  bank_.OnWrite(bank_.AddressOf("AcquisitionStart"), [this](Bytes* value) {
    acquiring_ = true;
    const std::uint32_t mode = bank_.Get("AcquisitionMode");
    frames_left_ = mode == kMultiFrame ? bank_.Get("AcquisitionFrameCount") : 1;
    rate_credit_ = 0.0;
    *value = Encode32(0);
    return ErrorCode::kSuccess;
  });
  bank_.OnWrite(bank_.AddressOf("AcquisitionStop"), [this](Bytes* value) {
    acquiring_ = false;
    *value = Encode32(0);
    return ErrorCode::kSuccess;
  });
  bank_.OnRead(bank_.AddressOf("PayloadSize"), [this](Bytes* value) {
    *value = Encode32(static_cast<std::uint32_t>(PayloadSize_B()));
  });
  bank_.OnRead(bank_.AddressOf("DeviceTemperature"), [this](Bytes* value) {
    const double age_s = static_cast<double>(wall_clock_() - started_ns_) * 1e-9;
    *value = EncodeDouble(25.0 + 15.0 * (1.0 - std::exp(-age_s / 900.0)));  // it warms up
  });
}

void CameraState::WireClock() {
  const auto latch = [this](Bytes* value) {
    Latch();
    *value = Encode32(0);
    return ErrorCode::kSuccess;
  };
  const auto reset = [this](Bytes* value) {
    clock_zero_ns_ += static_cast<std::int64_t>(Timestamp_ns(wall_clock_()));
    *value = Encode32(0);
    return ErrorCode::kSuccess;
  };
  bank_.OnWrite(bank_.AddressOf("TimestampLatch"), latch);
  bank_.OnWrite(bank_.AddressOf("TimestampReset"), reset);
  bank_.OnWrite(bank_.AddressOf("PtpDataSetLatch"), latch);
  bank_.OnWrite(boot::kTimestampControl, [=](Bytes* value) {
    const std::uint32_t asked = Get32(*value, 0);
    if ((asked & kTimestampLatch) != 0) latch(value);
    if ((asked & kTimestampReset) != 0) reset(value);
    return ErrorCode::kSuccess;
  });
  const auto latched = [this](Bytes* value) { *value = Encode64(latched_ns_); };
  bank_.OnRead(bank_.AddressOf("TimestampLatchValue"), latched);
  bank_.OnRead(bank_.AddressOf("Timestamp"),
               [this](Bytes* value) { *value = Encode64(Timestamp_ns(wall_clock_())); });
  bank_.OnRead(boot::kTimestampHigh, [this](Bytes* value) {
    *value = Encode32(static_cast<std::uint32_t>(latched_ns_ >> 32));
  });
  bank_.OnRead(boot::kTimestampLow, [this](Bytes* value) {
    *value = Encode32(static_cast<std::uint32_t>(latched_ns_));
  });
  bank_.OnRead(bank_.AddressOf("PtpStatus"), [this](Bytes* value) {
    *value = Encode32(bank_.Get("PtpEnable") != 0 ? kPtpSlave : kPtpDisabled);
  });
}

void CameraState::Latch() { latched_ns_ = Timestamp_ns(wall_clock_()); }

std::uint64_t CameraState::Timestamp_ns(std::int64_t stamp_ns) const {
  const std::int64_t shift_ns = bank_.Get("PtpEnable") != 0 ? kTaiFromUtc_ns : -clock_zero_ns_;
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, stamp_ns + shift_ns));
}

void CameraState::WireStreamChannel() {
  bank_.OnWrite(boot::kHeartbeatTimeout, [](Bytes* value) {
    *value =
        Encode32(std::clamp(Get32(*value, 0), kMinHeartbeatTimeout_ms, kMaxHeartbeatTimeout_ms));
    return ErrorCode::kSuccess;
  });
  bank_.OnWrite(boot::kStreamPort, [this](Bytes* value) {
    const bool open = (Get32(*value, 0) & 0xffff) != 0;
    *value = Encode32(Get32(*value, 0) & 0xffff);
    bank_.Set(boot::kStreamPort, Get32(*value, 0));
    if (on_stream_channel) on_stream_channel(open);
    return ErrorCode::kSuccess;
  });
  bank_.OnWrite(boot::kStreamPacketSize, [this](Bytes* value) {
    const std::uint32_t asked = Get32(*value, 0);
    const std::uint32_t size =
        std::clamp(asked & 0xffff, kMinPacketSize, kMaxPacketSize) & ~std::uint32_t{3};
    *value = Encode32((asked & kDoNotFragment) | size);
    bank_.Set(boot::kStreamPacketSize, Get32(*value, 0));
    if ((asked & kFireTestPacket) != 0 && on_test_packet) on_test_packet(Destination());
    return ErrorCode::kSuccess;
  });
}

void CameraState::WireRegions() {
  const auto judge = [this](const char* name, const char* other, const char* max,
                            std::uint32_t least) {
    bank_.OnWrite(bank_.AddressOf(name), [=, this](Bytes* value) {
      const std::uint64_t asked = Get32(*value, 0);
      if (acquiring_) return ErrorCode::kWriteProtect;
      const bool fits = asked >= least && asked + bank_.Get(other) <= bank_.Get(max);
      return fits ? ErrorCode::kSuccess : ErrorCode::kInvalidParameter;
    });
  };
  judge("Width", "OffsetX", "WidthMax", 16);
  judge("Height", "OffsetY", "HeightMax", 16);
  judge("OffsetX", "Width", "WidthMax", 0);
  judge("OffsetY", "Height", "HeightMax", 0);
  bank_.OnWrite(bank_.AddressOf("ComponentEnable"), [this](Bytes* value) {
    if (acquiring_) return ErrorCode::kWriteProtect;
    return Get32(*value, 0) <= 1 ? ErrorCode::kSuccess : ErrorCode::kInvalidParameter;
  });
  bank_.OnWrite(bank_.AddressOf("PixelFormat"), [this](Bytes* value) {
    const bool same = Get32(*value, 0) == bank_.Get("PixelFormat");  // each component has one
    return same ? ErrorCode::kSuccess : ErrorCode::kInvalidParameter;
  });
}

Region CameraState::RegionOf(std::size_t component) const {
  return {bank_.GetSelected("Width", component), bank_.GetSelected("Height", component),
          bank_.GetSelected("OffsetX", component), bank_.GetSelected("OffsetY", component)};
}

StreamPlan CameraState::Destination() const {
  StreamPlan plan;
  plan.address = bank_.Get(boot::kStreamAddress);
  plan.port = static_cast<std::uint16_t>(bank_.Get(boot::kStreamPort));
  plan.packet_size = bank_.Get(boot::kStreamPacketSize) & 0xffff;
  plan.do_not_fragment = (bank_.Get(boot::kStreamPacketSize) & kDoNotFragment) != 0;
  plan.packet_delay_ns = bank_.Get(boot::kStreamPacketDelay);
  plan.invalid_depth = invalid_depth_;
  const bool multipart = (bank_.Get(boot::kStreamChannelConfiguration) & kMultipartEnable) != 0;
  for (std::size_t i = 0; i < components_.size(); ++i) {
    if (bank_.GetSelected("ComponentEnable", i) == 0) continue;
    plan.components.push_back({components_[i], RegionOf(i)});
    if (!multipart) break;  // one image is all that such a client can take
  }
  const bool asked = (bank_.Get(boot::kStreamConfiguration) & kExtendedIdEnable) != 0;
  plan.extended_ids = asked || plan.components.size() > 1;  // parts need them
  return plan;
}

std::optional<StreamPlan> CameraState::Plan() const {
  StreamPlan plan = Destination();
  const bool complete = plan.address != 0 && plan.port != 0 && !plan.components.empty();
  if (!acquiring_ || !complete) return std::nullopt;
  return plan;
}

bool CameraState::TakeFrame() {
  if (bank_.Get("AcquisitionFrameRateEnable") != 0) {
    rate_credit_ += bank_.GetDouble("AcquisitionFrameRate") / rate_hz_;
    if (rate_credit_ < 1.0) return false;
    rate_credit_ = std::fmod(rate_credit_, 1.0);
  }
  if (bank_.Get("AcquisitionMode") != kContinuous && --frames_left_ == 0) acquiring_ = false;
  return true;
}

std::uint64_t CameraState::PayloadSize_B() const {
  std::uint64_t size_B = 0;
  for (const StreamPlan::Component& component : Destination().components) {
    size_B += std::uint64_t{component.region.width} * component.region.height *
              BytesPerPixel(component.id);
  }
  return size_B;
}

void CameraState::ForgetClient() {
  acquiring_ = false;
  for (const std::uint32_t channel : {boot::kStreamPort, boot::kMessagePort}) bank_.Set(channel, 0);
  bank_.Set(boot::kControlConfiguration, 0);
  bank_.Set(bank_.AddressOf("TLParamsLocked"), 0);
  if (on_stream_channel) on_stream_channel(false);
}

}  // namespace palpate::gige_vision
