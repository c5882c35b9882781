// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::command {

/// One decoded value of a message: a number, a text, a list or a message.
struct MessageValue {
  enum class Kind { kNumber, kText, kNumbers, kList, kMessage };

  Kind kind = Kind::kNumber;
  std::string type;  ///< ROS name: "float64", "string", "std_msgs/Header"; of a list its items'
  bool is_array = false;   ///< of a list: of fixed length
  std::uint64_t bits = 0;  ///< of a number
  std::string text;
  std::string_view
      numbers;  ///< of kNumbers: `count` of them as in the message, whose bytes these are
  std::uint64_t count = 0;          ///< of a list
  bool swaps_bytes = false;         ///< kNumbers are in the other byte order
  std::vector<MessageValue> items;  ///< of kList
  std::vector<std::pair<std::string, MessageValue>> fields = {};  ///< of kMessage

  /// Item of kNumbers.
  std::uint64_t BitsAt(std::uint64_t index) const;
};

/// Decodes a message of any type; nullopt where the bytes do not fit. `cdr`: with its header of 4
/// bytes; must outlive the value.
std::optional<MessageValue> DecodeMessage(std::string_view cdr, const std::string& type,
                                          const recording::Definitions& definitions);

/// The part that `path` names: "header.stamp", "markers[2].position". Throws InputError with "did
/// you mean" where there is none.
const MessageValue& SelectField(const MessageValue& message, const std::string& path);

struct PrintOptions {
  /// Lists and texts longer than this are cut; 0: none.
  std::uint64_t truncate_length = 0;
  bool no_lists = false;  ///< type and length in their place
  bool no_texts = false;
};

/// As `ros2 topic echo` prints it, without the line of dashes.
std::string YamlText(const MessageValue& value, const PrintOptions& options);
/// As `ros2 topic echo --csv` does.
std::string CsvText(const MessageValue& value, const PrintOptions& options);
/// One JSON value on one line. Numbers that are not finite are null.
std::string JsonText(const MessageValue& value, const PrintOptions& options);

/// A number as Python writes it: 0.1, 1.0, 1e-05, nan, inf.
std::string PythonNumber(double value);
/// A text as a scalar of YAML, quoted where it must be.
std::string YamlScalar(const std::string& text);

}  // namespace palpate::command
