// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::recording {

/// How many values a field has.
enum class Repeat {
  kOne,
  kFixed,     ///< an array of Field::count
  kSequence,  ///< any number, which stands in front of the values
};

struct Field {
  std::string type;  ///< ROS name: "uint8", "string", "std_msgs/Header"
  std::string name;
  Repeat repeat = Repeat::kOne;
  std::uint32_t count = 0;  ///< of an array

  bool operator==(const Field&) const = default;
};

struct Constant {
  std::string type;
  std::string name;
  std::string value;

  bool operator==(const Constant&) const = default;
};

/// One message type of ROS 2.
struct MessageDefinition {
  std::string name;  ///< "sensor_msgs/Image"
  std::vector<Constant> constants;
  std::vector<Field> fields;

  bool operator==(const MessageDefinition&) const = default;
};

using Definitions = std::map<std::string, MessageDefinition>;  ///< by name

/// Size of a number's type in bytes; 0 for strings and messages.
std::uint32_t SizeOfPrimitive(std::string_view ros_type);

/// "sensor_msgs/msg/Image" and "sensor_msgs/Image" -> "sensor_msgs/Image".
std::string ShortTypeName(std::string_view ros_type);

/// Reads the only struct of an .idl file of the folder idl/. Throws InputError for what such files
/// do not have.
MessageDefinition ParseIdl(std::string_view text, const std::string& file);

/// Reads a schema of encoding "ros2msg": the definition of `ros_type`, and after lines of "=" and
/// "MSG: package/Name" those that it uses. Throws InputError where it is none.
Definitions ParseRos2msg(const std::string& ros_type, std::string_view text);

/// Reads a schema of encoding "omgidl", as dds::IdlOfEndpoint writes it: structs by their full name
/// ("a::b::Name_"), enumerations as int32. Throws InputError for what CdrReader cannot read:
/// mutable types, optional members, nested sequences.
Definitions ParseOmgIdl(std::string_view text);

/// The schema of encoding "ros2msg" of a type; nullopt where it, or a type that it uses, is not
/// among `definitions`.
std::optional<std::string> FormatRos2msg(const std::string& ros_type,
                                         const Definitions& definitions);

/// All types of the folder idl/, as they were when this program was built.
const Definitions& BuiltInDefinitions();

}  // namespace palpate::recording
