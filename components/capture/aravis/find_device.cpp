// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/find_device.hpp"

#include <mutex>

#include "components/capture/network/control_probe.hpp"
#include "components/capture/network/packet_size.hpp"

namespace palpate::capture {

namespace {

constexpr double kAnswerTime_s = 0.2;
constexpr int kProbes = 3;  ///< a packet may be lost, a busy camera late
constexpr const char* kFakeId = "Fake_1";

std::string OrEmpty(const char* text) { return text != nullptr ? text : ""; }

bool Answers(const std::string& address) {
  for (int probe = 0; probe < kProbes; ++probe) {
    if (ProbeControl(address, kAnswerTime_s) != Probe::kSilent) return true;
  }
  return false;
}

FoundDevice AtAddress(const std::string& address) {
  FoundDevice found;
  found.address = found.id = address;
  // Aravis would ask for seconds.
  if (!Answers(address)) {
    found.reason = "no camera answers at " + address;
  }
  return found;
}

FoundDevice OfList(const ListedDevice& device) {
  FoundDevice found;
  found.id = device.id;
  if (device.protocol == "GigEVision" && IsIpv4Address(device.address)) {
    found.address = device.address;
  }
  return found;
}

std::string Names(const std::vector<ListedDevice>& devices) {
  std::string names;
  for (const ListedDevice& device : devices) {
    names += (names.empty() ? "" : ", ") + device.vendor + "-" + device.serial + " (" +
             device.address + ")";
  }
  return names;
}

}  // namespace

std::vector<ListedDevice> ListDevices() {
  arv_update_device_list();
  std::vector<ListedDevice> devices;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    devices.push_back({OrEmpty(arv_get_device_id(i)), OrEmpty(arv_get_device_physical_id(i)),
                       OrEmpty(arv_get_device_vendor(i)), OrEmpty(arv_get_device_model(i)),
                       OrEmpty(arv_get_device_serial_nbr(i)), OrEmpty(arv_get_device_address(i)),
                       OrEmpty(arv_get_device_protocol(i))});
  }
  return devices;
}

namespace {

FoundDevice Find(const CameraTarget& target, const std::string& known_address) {
  if (target.fake) {
    arv_enable_interface("Fake");
    const std::string& file = target.fake_description;
    arv_set_fake_camera_genicam_filename(file.empty() ? nullptr : file.c_str());
    FoundDevice found;
    found.id = kFakeId;
    return found;
  }
  if (!known_address.empty()) return AtAddress(known_address);
  if (IsIpv4Address(target.id)) return AtAddress(target.id);
  const auto devices = ListDevices();
  if (target.id.empty() && devices.size() == 1) return OfList(devices[0]);
  for (const ListedDevice& device : devices) {
    if (!target.id.empty() && IsMeant(target.id, device)) return OfList(device);
  }
  FoundDevice none;
  if (devices.empty()) {
    none.reason = "no camera answers; where it is on another network, give its address (camera_id)";
  } else if (target.id.empty()) {
    none.reason = "several cameras, choose one (camera_id): " + Names(devices);
  } else {
    none.reason = "no camera " + target.id + "; there are: " + Names(devices);
  }
  return none;
}

}  // namespace

FoundDevice FindDevice(const CameraTarget& target, const std::string& known_address) {
  FoundDevice found = Find(target, known_address);
  if (!found.address.empty()) {
    found.local_address = target.interface_address.empty()
                              ? LocalAddressTowards(found.address).value_or("0.0.0.0")
                              : target.interface_address;
  }
  return found;
}

GObjectPtr<ArvDevice> OpenDevice(const FoundDevice& found, std::string* reason) {
  // Aravis reads descriptions with objects that all devices share without a lock.
  static std::mutex opening;
  const std::lock_guard lock(opening);
  GErrorHolder error;
  GObjectPtr<ArvDevice> device;
  if (found.address.empty()) {
    device.reset(arv_open_device(found.id.c_str(), error.Take()));
  } else {
    const GObjectPtr<GInetAddress> from(
        g_inet_address_new_from_string(found.local_address.c_str()));
    const GObjectPtr<GInetAddress> to(g_inet_address_new_from_string(found.address.c_str()));
    if (from && to) device.reset(arv_gv_device_new(from.get(), to.get(), error.Take()));
  }
  if (!device || !error.ok()) {
    *reason =
        "cannot open " + found.id + ": " + (error.ok() ? std::string("no answer") : error.text());
    device.reset();
  }
  return device;
}

}  // namespace palpate::capture
