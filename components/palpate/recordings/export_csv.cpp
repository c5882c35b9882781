// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <map>
#include <vector>

#include "components/palpate/recordings/topic_export.hpp"
#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros2msg/flatten.hpp"

namespace palpate::command {

namespace {

/// A text as a field of a CSV (RFC 4180).
std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

class CsvExport : public TopicExport {
 public:
  CsvExport(offline::MessageType type, std::filesystem::path file, std::int64_t start_ns)
      : type_(std::move(type)), file_(std::move(file)), start_ns_(start_ns) {}

  std::string Take(const recording::Message& message) override {
    const auto flat = recording::Flatten(message.data, type_.name, type_.definitions);
    if (!flat) return "does not fit the definition of its type";
    std::vector<std::string> row{FormatNumber(NsToSeconds(message.log_time_ns - start_ns_)),
                                 std::to_string(message.log_time_ns)};
    for (const auto& [column, value] : *flat) {
      const auto place = columns_.emplace(column, names_.size());
      if (place.second) names_.push_back(column);
      const std::size_t index = place.first->second;
      row.resize(std::max(row.size(), index + 1));
      row[index] = CsvField(value);
    }
    rows_.push_back(std::move(row));
    return {};
  }

  void Finish() override {
    std::string text = Listed(names_, names_.size());
    for (const std::vector<std::string>& row : rows_) text += Listed(row, names_.size());
    WriteFile(file_, text);
  }

 private:
  static std::string Listed(const std::vector<std::string>& fields, std::size_t count) {
    std::string line;
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) line += ',';
      if (i < fields.size()) line += fields[i];
    }
    return line + "\n";
  }

  offline::MessageType type_;
  std::filesystem::path file_;
  std::int64_t start_ns_;
  std::vector<std::string> names_{"t_s", "log_time_ns"};
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeCsvExport(offline::MessageType type, std::filesystem::path file,
                                           std::int64_t start_ns) {
  return std::make_unique<CsvExport>(std::move(type), std::move(file), start_ns);
}

}  // namespace palpate::command
