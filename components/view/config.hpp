// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::view {

/// Where the page is, and who may open it.
struct HttpConfig {
  std::string address = "127.0.0.1";
  int port = 8750;
  int further_ports = 20;
  std::filesystem::path token_file;
  std::vector<std::string> host_names;
  int max_clients = 16;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("address", address,
      "IP address to listen on, for Foxglove too; another one than this machine's own (127.0.0.1, "
      "::1) needs a token");
    v("port", port, {.min = 0, .max = 65535}, "TCP port of the page; 0: any free one");
    v("further_ports", further_ports, {.min = 0, .max = 1000},
      "So many following ports are tried where a port is in use, for Foxglove too");
    v("token_file", token_file,
      "File whose first line is the token that a client must give, 16 to 256 letters, digits, - "
      "and _; empty: the environment variable PALPATE_VIEW_TOKEN, else none");
    v("host_names", host_names,
      "Names under which browsers may open the page, besides the address and localhost");
    v("max_clients", max_clients, {.min = 1, .max = 256},
      "WebSockets open at a time, of the page and of Foxglove each");
  }
};

/// For Foxglove and Lichtblick.
struct FoxgloveConfig {
  bool enabled = true;
  int port = 8765;
  std::vector<std::string> origins = {"https://app.foxglove.dev", "file://"};
  double scene_rate_hz = 10.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("enabled", enabled, "Serve the WebSocket protocol of Foxglove and Lichtblick");
    v("port", port, {.min = 0, .max = 65535}, "TCP port of that protocol; 0: any free one");
    v("origins", origins,
      "Web pages that may connect, as browsers name them, besides those of this machine; file:// "
      "is "
      "the desktop program");
    v("scene_rate_hz", scene_rate_hz, {.min = 0.1, .max = 60.0},
      "Most messages per second of /view/robot_scene");
  }
};

/// Camera images of the page.
struct ImageConfig {
  double max_rate_hz = 10.0;
  int max_width_px = 640;
  int quality = 75;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("max_rate_hz", max_rate_hz, {.min = 0.1, .max = 60.0}, "Most images per second, each");
    v("max_width_px", max_width_px, {.min = 16, .max = 8192},
      "Wider images are halved until they are not wider");
    v("quality", quality, {.min = 1, .max = 100}, "JPEG quality");
  }
};

/// What is measured of the model's surface by the cloud.
struct ResidualConfig {
  double radius_m = 0.005;
  double rate_hz = 5.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("radius_m", radius_m, {.min = 0.0, .max = 1.0, .min_open = true},
      "Only points this near to a node of the surface count");
    v("rate_hz", rate_hz, {.min = 0.0, .max = 60.0},
      "Most residuals of the surface per second; 0: none");
  }
};

/// The smallest force that could be felt, of a click on the skin.
struct ProbeConfig {
  double radius_m = 0.006;
  double significance = 1e-5;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("radius_m", radius_m, {.min = 0.0, .max = 1.0},
      "Radius of the patch over which the force is spread; 0: one point");
    v("significance", significance, {.min = 0.0, .max = 0.5, .min_open = true},
      "False-alarm probability per frame at which a force counts as felt");
  }
};

/// Settings of the process.
struct Config {
  std::filesystem::path robot;
  bool allow_control = false;
  std::filesystem::path record_folder;
  HttpConfig http;
  FoxgloveConfig foxglove;
  ImageConfig images;
  ResidualConfig residual;
  ProbeConfig probe;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("robot", robot,
      "Robot file, or name of a robot: for cables, stiffness and smallest forces; empty: they are "
      "not shown. Same as ROBOT");
    v("allow_control", allow_control, "Let the page start and stop recordings");
    v("record_folder", record_folder,
      "Folder of recordings that the page starts; empty: the current one");
    v("http", http, "The page");
    v("foxglove", foxglove, "The protocol of Foxglove");
    v("images", images, "Camera images");
    v("residual", residual, "Residual of the surface");
    v("probe", probe, "Clicks on the skin");
  }
};

}  // namespace palpate::view
