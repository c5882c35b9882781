// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "components/capture/decode/image_part.hpp"
#include "components/capture/genicam/features.hpp"
#include "components/capture/genicam/pixel_format.hpp"
#include "libs/core/status.hpp"

namespace palpate::capture {

/// Which camera is meant.
struct CameraTarget {
  std::string id;  ///< IPv4 address, "vendor-serial", serial number, MAC; empty: the only one
  std::string interface_address;  ///< of this host, where the routing table is not to decide
  bool fake = false;              ///< Aravis' in-process fake (Fake_1)
  std::string fake_description;   ///< its GenICam XML, a file; empty: Aravis' own
};

struct StreamSettings {
  int buffers = 10;
  int socket_buffer_bytes = 16 << 20;
  int packet_size_bytes = 0;  ///< 0: as large as interface and camera allow
  bool packet_resend = true;
  bool packet_socket = false;  ///< needs CAP_NET_RAW
};

/// What the transport counts, since the stream began.
struct StreamCounters {
  std::uint64_t packets_resent = 0;  ///< asked for again
  std::uint64_t packets_lost = 0;
  std::uint64_t underruns = 0;  ///< frames for which no buffer was free
};

/// A buffer that the camera filled, ours until it goes out of scope.
class FilledBuffer {
 public:
  /// An ArvStream, which must outlive this, and an ArvBuffer of it.
  FilledBuffer(void* stream, void* buffer) : stream_(stream), buffer_(buffer) {}
  FilledBuffer(FilledBuffer&& other) noexcept
      : stream_(other.stream_), buffer_(std::exchange(other.buffer_, nullptr)) {}
  FilledBuffer& operator=(FilledBuffer&&) = delete;
  ~FilledBuffer();

  bool complete() const;
  std::uint64_t frame_id() const;
  std::int64_t stamp_device_ns() const;
  /// The parts that lie within the buffer, eight at most; valid as long as this.
  std::span<const ImagePart> ReadParts(const PixelFormatCodes& codes);

 private:
  static constexpr std::size_t kMostParts = 8;
  void* stream_;
  void* buffer_;
  std::array<ImagePart, kMostParts> parts_;
};

/// One open GenICam device. Its destructor may take seconds where the device is gone. Only
/// Pop(), control_lost() and the counters may be used while another thread uses features().
class AravisCamera {
 public:
  /// Opens the device, or says why not. `known_address`: where it was last, else it is searched
  /// (1 s).
  static std::unique_ptr<AravisCamera> Open(const CameraTarget& target,
                                            const std::string& known_address, std::string* reason);
  ~AravisCamera();
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  const std::string& id() const { return id_; }  ///< "vendor-serial"
  const std::string& model() const { return model_; }
  const std::string& address() const { return address_; }  ///< empty: not on a network

  Features& features();
  std::string Description() const;  ///< the GenICam XML as the device sends it
  /// True where no other client controls the device, or it needs no control.
  bool TakeControl();
  /// Begins to stream; frames come with Pop(). `packet_limit_bytes`: at most, 0: no limit.
  Status Start(const StreamSettings& settings, int packet_limit_bytes);
  /// Waits for a filled buffer up to `timeout_s`.
  std::optional<FilledBuffer> Pop(double timeout_s);
  bool control_lost() const;
  StreamCounters counters() const;
  int port() const;  ///< UDP, of this host; 0: none
  int packet_size_bytes() const { return packet_size_bytes_; }
  /// The kernel keeps strangers' packets away from the stream.
  bool guarded() const { return guarded_; }

 private:
  struct Impl;
  explicit AravisCamera(std::unique_ptr<Impl> impl);
  void ReadIdentity();
  Status CreateStream(const StreamSettings& settings);
  Status ChoosePacketSize(const StreamSettings& settings, int packet_limit_bytes);

  std::unique_ptr<Impl> impl_;
  std::string id_;
  std::string model_;
  std::string address_;
  std::string local_address_;  ///< of this host, towards it
  int packet_size_bytes_ = 0;
  bool guarded_ = false;
};

}  // namespace palpate::capture
