// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/dds/node_settings.hpp"

namespace palpate::virtual_camera {

/// What the network does to the camera's packets, to test clients with.
struct ImpairmentConfig {
  double loss = 0.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("loss", loss, {.min = 0.0, .max = 1.0},
      "Share of the stream's packets that never leave (resent ones too)");
  }
};

/// Settings of the process.
struct NodeConfig {
  std::string camera_name;
  std::string interface_address = "127.0.0.1";
  std::string vendor = "Palpate";
  std::string model = "Virtual RGB-D";
  std::string serial = "VC000001";
  std::string user_name = "virtual camera";
  bool confidence = false;
  double silence_s = 2.0;
  ImpairmentConfig network;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("camera_name", camera_name,
      "Camera of the scenario's list cameras that this process is, taken at the same times as the "
      "first; empty: the first");
    v("interface_address", interface_address,
      "IPv4 address of the interface on which the camera is found (UDP port 3956)");
    v("vendor", vendor, "As the camera calls its maker");
    v("model", model, "As the camera calls itself");
    v("serial", serial, "Serial number");
    v("user_name", user_name, "Name that a user would give it");
    v("confidence", confidence, "Send a third part: how far each depth pixel is to be trusted");
    v("silence_s", silence_s, {.min = 0.0, .min_open = true},
      "Without a state of the virtual robot for so long the component reports itself stale");
    v("network", network, "What the network does to the packets");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::virtual_camera
