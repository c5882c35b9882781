// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::capture {

/// One device of Aravis' list.
struct ListedDevice {
  std::string id;  ///< Aravis' own: "vendor-model-serial", a maker's name sometimes shortened
  std::string physical_id;  ///< MAC of a network device
  std::string vendor, model, serial, address, protocol;
};

/// True where `id` means this device: "vendor-serial", serial number, MAC, address, or Aravis' id.
inline bool IsMeant(const std::string& id, const ListedDevice& device) {
  return id == device.vendor + "-" + device.serial || id == device.serial ||
         id == device.physical_id || id == device.address || id == device.id;
}

}  // namespace palpate::capture
