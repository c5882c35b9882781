// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/camera_list.hpp"

#include <algorithm>
#include <iomanip>
#include <memory>
#include <ostream>

#include "components/capture/aravis/aravis_camera.hpp"
#include "components/capture/aravis/find_device.hpp"
#include "components/capture/genicam/device_setup.hpp"
#include "components/capture/network/packet_size.hpp"

namespace palpate::capture {

namespace {

void Describe(Features& features, CameraDescription* camera) {
  const auto take = [&](std::string* target, const char* name) {
    if (target->empty()) *target = features.Text(name).value_or("");
  };
  take(&camera->vendor, "DeviceVendorName");
  take(&camera->model, "DeviceModelName");
  take(&camera->serial, "DeviceSerialNumber");
  const auto add = [&](const std::string& format) {
    auto& formats = camera->formats;
    if (!format.empty() && std::find(formats.begin(), formats.end(), format) == formats.end()) {
      formats.push_back(format);
    }
  };
  for (const auto& [name, code] : features.Choices("PixelFormat")) add(name);
  for (const auto& [name, id] : features.Choices("ComponentSelector")) {
    camera->components.push_back(name);
  }
}

/// At its address where it has one: ids need not be unique, as of two simulated cameras.
void OpenAndDescribe(const std::string& id, CameraDescription* camera) {
  const CameraTarget target = {
      .id = id, .interface_address = "", .fake = false, .fake_description = ""};
  const std::string address = IsIpv4Address(camera->address) ? camera->address : "";
  const auto device = AravisCamera::Open(target, address, &camera->trouble);
  if (device) Describe(device->features(), camera);
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text.empty() ? "-" : text;
}

}  // namespace

std::vector<CameraDescription> ListCameras(const std::vector<std::string>& addresses) {
  std::vector<CameraDescription> cameras;
  for (const ListedDevice& device : ListDevices()) {
    CameraDescription camera;
    camera.vendor = device.vendor;
    camera.model = device.model;
    camera.serial = device.serial;
    camera.address = device.address;
    camera.protocol = device.protocol;
    OpenAndDescribe(device.id, &camera);
    cameras.push_back(std::move(camera));
  }
  for (const std::string& address : addresses) {
    const bool known = std::any_of(cameras.begin(), cameras.end(),
                                   [&](const auto& camera) { return camera.address == address; });
    if (known) continue;
    CameraDescription camera;
    camera.address = address;
    camera.protocol = "GigEVision";
    OpenAndDescribe(address, &camera);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

void PrintCameras(const std::vector<CameraDescription>& cameras, std::ostream& out) {
  if (cameras.empty()) {
    out << "No camera answers. Is it switched on and on a network of this computer? Where it is "
           "on another one, give its address.\n";
    return;
  }
  std::vector<std::vector<std::string>> rows = {
      {"VENDOR", "MODEL", "SERIAL", "ADDRESS", "PROTOCOL", "COMPONENTS", "FORMATS"}};
  for (const CameraDescription& camera : cameras) {
    rows.push_back({camera.vendor, camera.model, camera.serial, camera.address, camera.protocol,
                    camera.trouble.empty() ? Joined(camera.components) : camera.trouble,
                    camera.trouble.empty() ? Joined(camera.formats) : "-"});
  }
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i].empty()) row[i] = "-";
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  for (const auto& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      out << std::left << std::setw(static_cast<int>(widths[i] + 2)) << row[i];
    }
    out << row.back() << '\n';
  }
}

}  // namespace palpate::capture
