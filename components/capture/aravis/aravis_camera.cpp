// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/aravis_camera.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "components/capture/aravis/aravis_features.hpp"
#include "components/capture/aravis/description_check.hpp"
#include "components/capture/aravis/find_device.hpp"
#include "components/capture/aravis/gobject.hpp"
#include "components/capture/network/packet_size.hpp"
#include "components/capture/network/stream_filter.hpp"

namespace palpate::capture {

namespace {

constexpr std::int64_t kGreatestPayload_bytes = 256 << 20;
/// For lost packets, and lost answers to asking for them, ten times in all.
constexpr unsigned kFrameRetention_us = 200000;
/// Packets of a frame that may be asked for again, as a share of all. Where a leader is lost Aravis
/// guesses how many there are; its own 0.25 gives such frames up.
constexpr double kPacketRequestRatio = 1.0;

bool IsImage(ArvBufferPartDataType type) {
  return type == ARV_BUFFER_PART_DATA_TYPE_2D_IMAGE || type == ARV_BUFFER_PART_DATA_TYPE_3D_IMAGE ||
         type == ARV_BUFFER_PART_DATA_TYPE_CONFIDENCE_MAP;
}

void OnControlLost(ArvDevice*, std::atomic<bool>* flag) { *flag = true; }

}  // namespace

struct AravisCamera::Impl {
  explicit Impl(GObjectPtr<ArvDevice> its_device)
      : device{std::move(its_device)}, features{device.get()} {
    signal =
        g_signal_connect(device.get(), "control-lost", G_CALLBACK(OnControlLost), &control_lost);
  }
  ~Impl() {
    stream.reset();
    g_signal_handler_disconnect(device.get(), signal);
  }

  GObjectPtr<ArvDevice> device;
  GObjectPtr<ArvStream> stream;
  AravisFeatures features;
  std::atomic<bool> control_lost{false};
  gulong signal = 0;
};

AravisCamera::AravisCamera(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

AravisCamera::~AravisCamera() {
  // A device that answers is commanded to stop; an absent one is not waited for.
  if (impl_->stream && !impl_->control_lost) impl_->features.Execute("AcquisitionStop").ok();
}

std::unique_ptr<AravisCamera> AravisCamera::Open(const CameraTarget& target,
                                                 const std::string& known_address,
                                                 std::string* reason) {
  FoundDevice found = FindDevice(target, known_address);
  if (!found.reason.empty()) {
    *reason = found.reason;
    return nullptr;
  }
  GObjectPtr<ArvDevice> device = OpenDevice(found, reason);
  if (!device) return nullptr;
  const Status sound = CheckDescription(device.get());
  if (!sound.ok()) {
    *reason = sound.message();
    return nullptr;
  }
  std::unique_ptr<AravisCamera> camera(new AravisCamera(std::make_unique<Impl>(std::move(device))));
  camera->address_ = found.address;
  camera->local_address_ = found.local_address;
  camera->id_ = found.id;
  camera->ReadIdentity();
  return camera;
}

void AravisCamera::ReadIdentity() {
  const auto vendor = impl_->features.Text("DeviceVendorName");
  auto serial = impl_->features.Text("DeviceSerialNumber");
  if (!serial) serial = impl_->features.Text("DeviceID");
  model_ = impl_->features.Text("DeviceModelName").value_or("");
  if (vendor && serial && !vendor->empty() && !serial->empty()) id_ = *vendor + "-" + *serial;
}

Features& AravisCamera::features() { return impl_->features; }

std::string AravisCamera::Description() const {
  std::size_t size = 0;
  const char* xml = arv_device_get_genicam_xml(impl_->device.get(), &size);
  return xml != nullptr ? std::string(xml, size) : std::string();
}

bool AravisCamera::TakeControl() {
  if (!ARV_IS_GV_DEVICE(impl_->device.get())) return true;
  ArvGvDevice* device = ARV_GV_DEVICE(impl_->device.get());
  if (arv_gv_device_is_controller(device)) return true;
  GErrorHolder error;
  return arv_gv_device_take_control(device, error.Take()) != 0;
}

Status AravisCamera::ChoosePacketSize(const StreamSettings& settings, int packet_limit_bytes) {
  if (!ARV_IS_GV_DEVICE(impl_->device.get())) return Status::Ok();
  int size = ChoosePacketSize_bytes(settings.packet_size_bytes, InterfaceMtu_bytes(local_address_),
                                    impl_->features.Range("GevSCPSPacketSize"));
  if (packet_limit_bytes > 0) size = std::min(size, packet_limit_bytes);
  const Status set = impl_->features.Set("GevSCPSPacketSize", std::int64_t{size});
  if (!set.ok()) {
    return {StatusCode::kInvalidInput, "the camera refuses packets of " + std::to_string(size) +
                                           " bytes (packet_size_bytes): " + set.message()};
  }
  packet_size_bytes_ = size;
  return Status::Ok();
}

Status AravisCamera::CreateStream(const StreamSettings& settings) {
  GErrorHolder error;
  impl_->stream.reset(
      arv_device_create_stream(impl_->device.get(), nullptr, nullptr, error.Take()));
  if (!impl_->stream || !error.ok()) {
    impl_->stream.reset();
    return {StatusCode::kInvalidInput, "no stream: " + error.text()};
  }
  if (ARV_IS_GV_STREAM(impl_->stream.get())) {
    g_object_set(impl_->stream.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                 "socket-buffer-size", settings.socket_buffer_bytes, "packet-resend",
                 settings.packet_resend ? ARV_GV_STREAM_PACKET_RESEND_ALWAYS
                                        : ARV_GV_STREAM_PACKET_RESEND_NEVER,
                 "packet-request-ratio", kPacketRequestRatio, "frame-retention", kFrameRetention_us,
                 nullptr);
  }
  return Status::Ok();
}

Status AravisCamera::Start(const StreamSettings& settings, int packet_limit_bytes) {
  const Status sized = ChoosePacketSize(settings, packet_limit_bytes);
  if (!sized.ok()) return sized;
  const auto payload = impl_->features.Integer("PayloadSize");
  if (!payload || *payload <= 0 || *payload > kGreatestPayload_bytes) {
    std::string message = "the camera's PayloadSize is " +
                          (payload ? std::to_string(*payload) + " bytes" : "missing") +
                          ", not in [1, 268435456]";
    for (const std::string& note : impl_->features.Notes()) message += "; " + note;
    return {StatusCode::kInvalidInput, message};
  }
  if (ARV_IS_GV_DEVICE(impl_->device.get())) {
    arv_gv_device_set_stream_options(ARV_GV_DEVICE(impl_->device.get()),
                                     settings.packet_socket
                                         ? ARV_GV_STREAM_OPTION_NONE
                                         : ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }
  const Status created = CreateStream(settings);
  if (!created.ok()) return created;
  guarded_ = GuardStreamSocket(local_address_, port(), address_,
                               LastPacketId(*payload, packet_size_bytes_));
  // Aravis copies a packet to where its number says; each number that the guard lets through has a
  // place in the buffer.
  const std::int64_t size = *payload + std::int64_t{kSparePackets + 2} * packet_size_bytes_;
  for (int i = 0; i < settings.buffers; ++i) {
    arv_stream_push_buffer(impl_->stream.get(),
                           arv_buffer_new_allocate(static_cast<std::size_t>(size)));
  }
  if (impl_->features.Has("TLParamsLocked")) {
    impl_->features.Set("TLParamsLocked", std::int64_t{1}).ok();
  }
  return impl_->features.Execute("AcquisitionStart");
}

bool AravisCamera::control_lost() const { return impl_->control_lost; }

int AravisCamera::port() const {
  ArvStream* stream = impl_->stream.get();
  if (stream == nullptr || !ARV_IS_GV_STREAM(stream)) return 0;
  return arv_gv_stream_get_port(ARV_GV_STREAM(stream));
}

StreamCounters AravisCamera::counters() const {
  StreamCounters counters;
  ArvStream* stream = impl_->stream.get();
  if (stream == nullptr) return counters;
  const auto info = [stream](const char* name) {
    return std::uint64_t{arv_stream_get_info_uint64_by_name(stream, name)};
  };
  counters.underruns = info("n_underruns");
  if (!ARV_IS_GV_STREAM(stream)) return counters;
  counters.packets_resent = info("n_resend_requests");
  counters.packets_lost = info("n_missing_packets");
  return counters;
}

std::optional<FilledBuffer> AravisCamera::Pop(double timeout_s) {
  ArvBuffer* buffer =
      arv_stream_timeout_pop_buffer(impl_->stream.get(), static_cast<guint64>(timeout_s * 1e6));
  if (buffer == nullptr) return std::nullopt;
  return FilledBuffer(impl_->stream.get(), buffer);
}

FilledBuffer::~FilledBuffer() {
  if (buffer_ != nullptr) arv_stream_push_buffer(ARV_STREAM(stream_), ARV_BUFFER(buffer_));
}

bool FilledBuffer::complete() const {
  return arv_buffer_get_status(ARV_BUFFER(buffer_)) == ARV_BUFFER_STATUS_SUCCESS;
}
std::uint64_t FilledBuffer::frame_id() const {
  return arv_buffer_get_frame_id(ARV_BUFFER(buffer_));
}
std::int64_t FilledBuffer::stamp_device_ns() const {
  return static_cast<std::int64_t>(arv_buffer_get_timestamp(ARV_BUFFER(buffer_)));
}

std::span<const ImagePart> FilledBuffer::ReadParts(const PixelFormatCodes& codes) {
  ArvBuffer* buffer = ARV_BUFFER(buffer_);
  std::size_t whole_size = 0;
  const auto* whole = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &whole_size));
  std::size_t count = 0;
  const guint reported = arv_buffer_get_n_parts(buffer);
  for (guint i = 0; i < reported && count < kMostParts; ++i) {
    if (!IsImage(arv_buffer_get_part_data_type(buffer, i))) continue;
    ImagePart part;
    std::size_t size = 0;
    part.data = static_cast<const std::uint8_t*>(arv_buffer_get_part_data(buffer, i, &size));
    // The sizes stand in a packet of the camera's, the buffer is ours.
    if (part.data == nullptr || part.data < whole || part.data > whole + whole_size) continue;
    part.size_bytes =
        std::min<std::size_t>(size, static_cast<std::size_t>(whole + whole_size - part.data));
    part.component_id = arv_buffer_get_part_component_id(buffer, i);
    part.format = codes.FormatOf(arv_buffer_get_part_pixel_format(buffer, i));
    part.width_px = arv_buffer_get_part_width(buffer, i);
    part.height_px = arv_buffer_get_part_height(buffer, i);
    gint row_padding = 0;
    gint end_padding = 0;
    arv_buffer_get_part_padding(buffer, i, &row_padding, &end_padding);
    part.row_padding_bytes = row_padding;
    parts_[count++] = part;
  }
  return {parts_.data(), count};
}

}  // namespace palpate::capture
