// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace palpate::capture {

/// One GenICam camera that answers.
struct CameraDescription {
  std::string model;
  std::string vendor;
  std::string serial;
  std::string address;                  ///< IPv4, or what the bus calls it
  std::string protocol;                 ///< GigEVision, USB3Vision
  std::vector<std::string> components;  ///< of a 3-D camera: Range, Intensity, ...
  std::vector<std::string> formats;     ///< pixel formats, all components together
  std::string trouble;  ///< why components and formats could not be read; empty: they were
};

/// All cameras that answer on the interfaces of this host (1 s), and those at `addresses`, which
/// need not be on a network of its own. Each is opened briefly, which leaves one
/// that another program controls alone.
std::vector<CameraDescription> ListCameras(const std::vector<std::string>& addresses = {});

/// A table for a person; says so where there is no camera.
void PrintCameras(const std::vector<CameraDescription>& cameras, std::ostream& out);

}  // namespace palpate::capture
