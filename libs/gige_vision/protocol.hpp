// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>

/// Numbers of the GigE Vision 2.0 standard (AIA): commands, status codes, bootstrap registers,
/// payload types; pixel formats of the Pixel Format Naming Convention.
namespace palpate::gige_vision {

inline constexpr std::uint16_t kControlPort = 3956;

enum class Command : std::uint16_t {  // an acknowledgement has the number of its command + 1
  kDiscovery = 0x0002,
  kForceIp = 0x0004,
  kPacketResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
};

enum class ErrorCode : std::uint16_t {
  kSuccess = 0x0000,
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
  kPacketUnavailable = 0x800c,
  kInvalidHeader = 0x800e,
};

inline constexpr std::uint8_t kCommandKey = 0x42;
inline constexpr std::uint8_t kAcknowledgeFlag = 0x01;
inline constexpr std::uint8_t kExtendedIdFlag = 0x10;  // in a resend command
inline constexpr std::size_t kControlHeaderSize = 8;
inline constexpr std::size_t kMaxReadSize = 536;  // of one READMEM
inline constexpr std::size_t kDiscoverySize = 0xf8;

/// Bootstrap registers.
namespace boot {
inline constexpr std::uint32_t kVersion = 0x0000;
inline constexpr std::uint32_t kDeviceMode = 0x0004;
inline constexpr std::uint32_t kMacHigh = 0x0008;
inline constexpr std::uint32_t kMacLow = 0x000c;
inline constexpr std::uint32_t kInterfaceCapability = 0x0010;
inline constexpr std::uint32_t kInterfaceConfiguration = 0x0014;
inline constexpr std::uint32_t kCurrentIp = 0x0024;
inline constexpr std::uint32_t kCurrentMask = 0x0034;
inline constexpr std::uint32_t kCurrentGateway = 0x0044;
inline constexpr std::uint32_t kManufacturer = 0x0048;
inline constexpr std::uint32_t kModel = 0x0068;
inline constexpr std::uint32_t kDeviceVersion = 0x0088;
inline constexpr std::uint32_t kManufacturerInfo = 0x00a8;
inline constexpr std::uint32_t kSerial = 0x00d8;
inline constexpr std::uint32_t kUserName = 0x00e8;
inline constexpr std::uint32_t kFirstUrl = 0x0200;
inline constexpr std::uint32_t kSecondUrl = 0x0400;
inline constexpr std::uint32_t kInterfaceCount = 0x0600;
inline constexpr std::uint32_t kPersistentIp = 0x064c;
inline constexpr std::uint32_t kPersistentMask = 0x065c;
inline constexpr std::uint32_t kPersistentGateway = 0x066c;
inline constexpr std::uint32_t kLinkSpeed = 0x0670;
inline constexpr std::uint32_t kMessageChannelCount = 0x0900;
inline constexpr std::uint32_t kStreamChannelCount = 0x0904;
inline constexpr std::uint32_t kActiveLinkCount = 0x0910;
inline constexpr std::uint32_t kStreamCapability = 0x092c;
inline constexpr std::uint32_t kMessageCapability = 0x0930;
inline constexpr std::uint32_t kControlCapability = 0x0934;
inline constexpr std::uint32_t kHeartbeatTimeout = 0x0938;
inline constexpr std::uint32_t kTickFrequencyHigh = 0x093c;
inline constexpr std::uint32_t kTickFrequencyLow = 0x0940;
inline constexpr std::uint32_t kTimestampControl = 0x0944;
inline constexpr std::uint32_t kTimestampHigh = 0x0948;
inline constexpr std::uint32_t kTimestampLow = 0x094c;
inline constexpr std::uint32_t kControlConfiguration = 0x0954;
inline constexpr std::uint32_t kPendingTimeout = 0x0958;
inline constexpr std::uint32_t kStreamConfiguration = 0x0960;
inline constexpr std::uint32_t kLinkConfigurationCapability = 0x0964;
inline constexpr std::uint32_t kLinkConfiguration = 0x0968;
inline constexpr std::uint32_t kControlPrivilege = 0x0a00;
inline constexpr std::uint32_t kPrimaryPort = 0x0a04;
inline constexpr std::uint32_t kPrimaryAddress = 0x0a14;
inline constexpr std::uint32_t kMessagePort = 0x0b00;
inline constexpr std::uint32_t kMessageAddress = 0x0b10;
inline constexpr std::uint32_t kMessageTimeout = 0x0b14;
inline constexpr std::uint32_t kMessageRetries = 0x0b18;
inline constexpr std::uint32_t kMessageSourcePort = 0x0b1c;
inline constexpr std::uint32_t kStreamPort = 0x0d00;
inline constexpr std::uint32_t kStreamPacketSize = 0x0d04;
inline constexpr std::uint32_t kStreamPacketDelay = 0x0d08;
inline constexpr std::uint32_t kStreamAddress = 0x0d18;
inline constexpr std::uint32_t kStreamSourcePort = 0x0d1c;
inline constexpr std::uint32_t kStreamChannelCapability = 0x0d20;
inline constexpr std::uint32_t kStreamChannelConfiguration = 0x0d24;
inline constexpr std::uint32_t kEnd = 0xa000;  ///< of the bootstrap registers
}  // namespace boot

/// Name, serial number, heartbeat disable, link speed and primary application registers; resend,
/// WRITEMEM, several registers in one command.
inline constexpr std::uint32_t kControlCapabilities = 0xf800'0007;

inline constexpr std::uint32_t kPrivilegeExclusive = 0x1;
inline constexpr std::uint32_t kPrivilegeControl = 0x2;
inline constexpr std::uint32_t kTimestampReset = 0x1;
inline constexpr std::uint32_t kTimestampLatch = 0x2;
inline constexpr std::uint32_t kHeartbeatDisable = 0x1;          // control configuration
inline constexpr std::uint32_t kExtendedIdEnable = 0x4000'0000;  // stream configuration
inline constexpr std::uint32_t kMultipartEnable = 0x40;          // stream channel configuration
inline constexpr std::uint32_t kFireTestPacket = 0x8000'0000;    // packet size register
inline constexpr std::uint32_t kDoNotFragment = 0x4000'0000;

inline constexpr std::uint32_t kMinHeartbeatTimeout_ms = 100;  // the standard asks for 500 or less
inline constexpr std::uint32_t kMaxHeartbeatTimeout_ms = 600'000;

inline constexpr std::uint32_t kUdpOverhead = 28;  // IP and UDP headers; counted in packet sizes
inline constexpr std::uint32_t kMinPacketSize = 576;
inline constexpr std::uint32_t kMaxPacketSize = 9000;

enum class PayloadType : std::uint16_t { kImage = 0x0001, kMultipart = 0x000a };
enum class PacketFormat : std::uint8_t {
  kLeader = 1,
  kTrailer = 2,
  kImagePayload = 3,
  kMultipartPayload = 7
};
enum class PartType : std::uint16_t { kImage2d = 0x0001, kImage3d = 0x0005, kConfidence = 0x0009 };

inline constexpr std::uint32_t kCoord3dC16 = 0x0110'00b8;
inline constexpr std::uint32_t kRgb8 = 0x0218'0014;
inline constexpr std::uint32_t kConfidence8 = 0x0108'00c6;

/// ComponentIDValue of the Standard Features Naming Convention.
enum class ComponentId : std::uint16_t { kIntensity = 1, kRange = 4, kConfidence = 6 };

/// What a component's pixels are; PFNC's numbers hold their bits per pixel.
constexpr std::uint32_t PixelFormatOf(ComponentId id) {
  return id == ComponentId::kRange       ? kCoord3dC16
         : id == ComponentId::kIntensity ? kRgb8
                                         : kConfidence8;
}
constexpr std::uint32_t BytesPerPixel(ComponentId id) {
  return ((PixelFormatOf(id) >> 16) & 0xff) / 8;
}

}  // namespace palpate::gige_vision
