// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/capture/config.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::capture {

/// Settings of the process: those of the source, and those of its DDS side.
struct NodeConfig : Config {
  std::string camera_name;
  bool wait_for_reader = false;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    Config::Visit(v);
    v("camera_name", camera_name,
      "Name of a camera beside the first: its topics are /camera_NAME/...; empty: the first, "
      "/camera/...");
    v("wait_for_reader", wait_for_reader,
      "Start only when /camera/frame_info has a reader, so that no frame of a recording is missed");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::capture
