// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "libs/experiment/capture/capture_kind.hpp"
#include "libs/fem/mesh_io/mesh_kind.hpp"

namespace palpate::command {

/// What a file is, by its first bytes, and by its ending where these say nothing.
struct FileKind {
  enum class Family {
    kMesh,
    kCapture,   ///< markers over time
    kCloud,     ///< PLY, PCD
    kImage,     ///< PNG, JPEG
    kSettings,  ///< YAML: a robot file unless its keys say otherwise
    kOther,     ///< known, and taken by no verb
    kUnknown,
  };

  Family family = Family::kUnknown;
  fem::MeshKind mesh = fem::MeshKind::kNone;
  experiment::CaptureKind capture = experiment::CaptureKind::kNone;
  std::string name;    ///< "PLY point cloud"; empty of kSettings and kUnknown
  std::string advice;  ///< what is to be done with it, a sentence without its full stop
};

/// Throws InputError where the file cannot be read.
FileKind KindOf(const std::filesystem::path& file);

/// At most 80 characters of the beginning of the file, for a message; "binary" where it is.
std::string BeginningOf(const std::filesystem::path& file);

}  // namespace palpate::command
