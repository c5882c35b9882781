// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "components/palpate/info/file_kind.hpp"
#include "libs/fem/mesh_report.hpp"

namespace palpate::command {

/// A summary as a JSON document and as text.
struct Findings {
  nlohmann::ordered_json json;
  std::string text;
};

nlohmann::ordered_json MeshJson(const fem::MeshReport& report);

/// A mesh; `unit` m, cm or mm, empty: not told, then lengths are those of the file and the unit is
/// asked for. Throws InputError.
Findings DescribeMesh(const std::filesystem::path& file, const std::string& unit);

/// A capture, cloud, image or file that no verb takes: what it is, what it holds, which verb takes
/// it. Throws InputError where it is damaged.
Findings DescribeFile(const std::filesystem::path& file, const FileKind& kind);

/// A folder of the TUM RGB-D benchmark (depth.txt).
Findings DescribeTumFolder(const std::filesystem::path& folder);

}  // namespace palpate::command
