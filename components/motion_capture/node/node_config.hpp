// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/dds/node_settings.hpp"

namespace palpate::motion_capture {

/// Settings of the process.
struct NodeConfig {
  std::string T_robot_mocap;
  std::string natnet_version = "4.1";
  std::string multicast_group = "239.255.42.99";
  std::string interface_address = "0.0.0.0";
  int port = 1511;
  std::vector<std::string> rename;
  bool unlabelled = false;
  double sigma_m = 0.0;
  double latency_s = 0.0;
  double silence_s = 2.0;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("T_robot_mocap", T_robot_mocap,
      "Pose of the motion capture's frame in the robot frame, \"{translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\", and its `standard_error: {translation_m, rotation_rad}`, "
      "else 5 mm and 0.01 rad; required to run");
    v("natnet_version", natnet_version, "Version of the NatNet protocol; Motive 3.1 sends 4.1");
    v("multicast_group", multicast_group,
      "Multicast group of the server; empty: it sends to this host's address");
    v("interface_address", interface_address,
      "Address of the network interface to listen on; 0.0.0.0: the system's choice");
    v("port", port, {.min = 1, .max = 65535}, "UDP port of the frames");
    v("rename", rename,
      "Names of markers as \"SET-1:=NAME\"; without a rule a marker is named after its set and its "
      "place there, from 1");
    v("unlabelled", unlabelled,
      "Publish markers without a name, too, as palpate-calibration takes them");
    v("sigma_m", sigma_m, {.min = 0.0}, "Standard deviation of the positions; 0: unknown");
    v("latency_s", latency_s, {.min = 0.0, .max = 1.0},
      "Time from the exposure to the arrival of a frame, subtracted from its stamp");
    v("silence_s", silence_s, {.min = 0.0, .min_open = true},
      "Time without frames after which the status is stale");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::motion_capture
