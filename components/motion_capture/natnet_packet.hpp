// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::motion_capture {

/// Version of the NatNet protocol of the sender (Motive: Settings > Streaming, or its release).
struct NatNetVersion {
  int major = 4;
  int minor = 1;
};

/// "4.1" -> {4, 1}. Throws InputError for anything but two whole numbers, major 3 or 4.
NatNetVersion ParseNatNetVersion(const std::string& text);

/// The markers of one asset (rigid body, marker set), in the order of its definition.
struct NatNetMarkerSet {
  std::string name;
  std::vector<Eigen::Vector3f> positions_m;  ///< frame of the motion capture; zeros: not seen
};

/// What is used of a frame of motion capture.
struct NatNetFrame {
  std::int32_t number = 0;  ///< rises by 1 with each frame
  std::vector<NatNetMarkerSet> sets;
  std::vector<Eigen::Vector3f> unlabelled_m;  ///< frame of the motion capture
};

/// Whether a datagram is a frame; servers send other messages as well.
bool IsNatNetFrame(const std::uint8_t* data, std::size_t size);

/// Reads the marker sets and the unlabelled markers of a datagram (NatNet SDK, PacketClient).
/// kInvalidInput for one that is no frame, or ends before what it announces.
Status ParseNatNetFrame(const std::uint8_t* data, std::size_t size, const NatNetVersion& version,
                        NatNetFrame* frame);

}  // namespace palpate::motion_capture
