// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <string>
#include <vector>

#include "components/capture/aravis/aravis_camera.hpp"
#include "components/capture/aravis/gobject.hpp"
#include "components/capture/aravis/listed_device.hpp"

namespace palpate::capture {

struct FoundDevice {
  std::string reason;         ///< why none was found; empty: one was
  std::string id;             ///< Aravis': "vendor-serial"
  std::string address;        ///< of a GigE Vision device
  std::string local_address;  ///< of this host, towards it
};

/// All that answer on this host's interfaces (1 s).
std::vector<ListedDevice> ListDevices();

/// The device that is meant: at `known_address` where that is not empty, else by its address, else
/// by asking all interfaces (1 s).
FoundDevice FindDevice(const CameraTarget& target, const std::string& known_address);

/// Opens it; nullptr with the reason where that fails.
GObjectPtr<ArvDevice> OpenDevice(const FoundDevice& found, std::string* reason);

}  // namespace palpate::capture
