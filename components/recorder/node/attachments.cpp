// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/attachments.hpp"

#include <map>

#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/file.hpp"

namespace palpate::recorder {

namespace {

std::string MediaType(const std::string& extension) {
  static const std::map<std::string, std::string> kTypes{
      {".yaml", "application/yaml"}, {".yml", "application/yaml"}, {".json", "application/json"},
      {".vtu", "application/xml"},   {".xml", "application/xml"},  {".csv", "text/csv"},
      {".txt", "text/plain"},        {".png", "image/png"}};
  const auto found = kTypes.find(extension);
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

/// Replaces a path in the text of its file by its last part.
void NameAsNeighbour(const ConfigNode& path, std::string* text) {
  std::size_t line = 0;
  for (int i = 1; i < path.where.line; ++i) line = text->find('\n', line) + 1;
  const std::size_t at = text->find(path.text, line);
  if (at == std::string::npos) return;
  text->replace(at, path.text.size(), std::filesystem::path(path.text).filename().string());
}

}  // namespace

recording::Attachment AttachmentOf(const std::string& name, std::string text) {
  const std::int64_t now_ns = WallNow_ns();
  return {.log_time_ns = now_ns,
          .create_time_ns = now_ns,
          .name = name,
          .media_type = MediaType(std::filesystem::path(name).extension().string()),
          .data = std::move(text)};
}

recording::Attachment AttachmentOf(const std::filesystem::path& file) {
  return AttachmentOf(file.filename().string(), ReadFile(file));
}

std::vector<recording::Attachment> AttachRobot(const std::filesystem::path& robot_file) {
  std::vector<recording::Attachment> attachments{AttachmentOf(robot_file)};
  const ConfigNode robot = app::LoadYaml(robot_file);
  const ConfigNode* mesh = robot.Find("mesh");
  const ConfigNode* mesh_file = mesh == nullptr ? nullptr : mesh->Find("file");
  if (mesh_file == nullptr) return attachments;
  const std::string given = mesh_file->text;
  const std::filesystem::path mesh_path = robot_file.parent_path() / given;
  const std::filesystem::path below = std::filesystem::path(given).lexically_normal();
  if (below.is_relative() && *below.begin() != "..") {
    attachments.push_back(AttachmentOf(below.generic_string(), ReadFile(mesh_path)));
    return attachments;
  }
  // Beside the attached robot file no other folder is known: there it names its neighbour.
  attachments.push_back(AttachmentOf(mesh_path));
  NameAsNeighbour(*mesh_file, &attachments.front().data);
  return attachments;
}

}  // namespace palpate::recorder
