// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros2msg/flatten.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>

#include "libs/core/text.hpp"

namespace palpate::recording {

namespace {

constexpr std::uint64_t kMostColumns = 100;
/// No message of ROS nests deeper; a definition that uses itself must end.
constexpr int kDeepest = 50;

/// Units of fields of ROS's own types, whose names do not tell them (REP 103). Positions of joints
/// are those of cables here.
std::string UnitOf(const std::string& type, const std::string& field) {
  static const std::map<std::pair<std::string, std::string>, std::string> kUnits{
      {{"geometry_msgs/Wrench", "force"}, "_N"},
      {{"geometry_msgs/Wrench", "torque"}, "_N_m"},
      {{"geometry_msgs/Pose", "position"}, "_m"},
      {{"geometry_msgs/Transform", "translation"}, "_m"},
      {{"sensor_msgs/JointState", "position"}, "_m"},
      {{"sensor_msgs/JointState", "velocity"}, "_m_s"},
      {{"sensor_msgs/JointState", "effort"}, "_N"},
      {{"sensor_msgs/CameraInfo", "height"}, "_px"},
      {{"sensor_msgs/CameraInfo", "width"}, "_px"},
      {{"sensor_msgs/Image", "height"}, "_px"},
      {{"sensor_msgs/Image", "width"}, "_px"}};
  const auto found = kUnits.find({type, field});
  return found == kUnits.end() ? "" : found->second;
}

std::string NumberText(std::uint64_t bits, const std::string& type) {
  if (type == "uint64") return std::to_string(bits);
  if (type == "int64") return std::to_string(static_cast<std::int64_t>(bits));
  const double value = NumberOf(bits, type);
  if (!std::isfinite(value)) return {};
  if (type != "float32") return FormatNumber(value);
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(),
                                 std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                       .ptr;
  return {text.data(), end};
}

class Flattener {
 public:
  Flattener(std::string_view cdr, const Definitions& definitions)
      : cdr_(cdr), definitions_(definitions) {}

  std::optional<FlatMessage> Run(const std::string& type) && {
    Message(type, "");
    if (!cdr_.ok() || failed_) return std::nullopt;
    return std::move(flat_);
  }

 private:
  void Message(const std::string& type, const std::string& path) {
    const auto found = definitions_.find(type);
    if (found == definitions_.end() || ++depth_ > kDeepest) {
      failed_ = true;
      return;
    }
    const std::string dot = path.empty() ? "" : path + ".";
    for (const Field& field : found->second.fields) {
      if (failed_ || !cdr_.ok()) return;
      Values(field, dot + field.name + UnitOf(type, field.name));
    }
    --depth_;
  }

  void Values(const Field& field, const std::string& path) {
    if (field.repeat == Repeat::kOne) return One(field.type, path);
    CdrReader before = cdr_;
    const std::uint64_t count = field.repeat == Repeat::kFixed ? field.count : cdr_.Length();
    if (count > kMostColumns) {
      flat_.emplace_back(path + ".length", std::to_string(count));
      before.Skip(field, definitions_);
      cdr_ = before;
      return;
    }
    for (std::uint64_t i = 0; i < count && cdr_.ok() && !failed_; ++i) {
      One(field.type, path + "[" + std::to_string(i) + "]");
    }
  }

  void One(const std::string& type, const std::string& path) {
    if (const std::uint32_t size = SizeOfPrimitive(type)) {
      flat_.emplace_back(path, NumberText(cdr_.Bits(size), type));
    } else if (type == "string") {
      flat_.emplace_back(path, std::string(cdr_.String()));
    } else if (type == "builtin_interfaces/Time") {
      const auto seconds = static_cast<std::int32_t>(cdr_.Bits(4));
      const auto ns = static_cast<std::int64_t>(cdr_.Bits(4));
      flat_.emplace_back(path + "_ns", std::to_string(seconds * std::int64_t{1'000'000'000} + ns));
    } else {
      Message(type, path);
    }
  }

  CdrReader cdr_;
  const Definitions& definitions_;
  FlatMessage flat_;
  int depth_ = 0;
  bool failed_ = false;
};

}  // namespace

std::optional<FlatMessage> Flatten(std::string_view cdr, const std::string& ros_type,
                                   const Definitions& definitions) {
  return Flattener(cdr, definitions).Run(ShortTypeName(ros_type));
}

CdrReader AtField(std::string_view cdr, const std::string& ros_type, const std::string& name,
                  const Definitions& definitions) {
  const auto root = definitions.find(ShortTypeName(ros_type));
  if (root != definitions.end()) {
    CdrReader reader(cdr);
    for (const Field& field : root->second.fields) {
      if (field.name == name) return reader;
      reader.Skip(field, definitions);
    }
  }
  return CdrReader({});
}

}  // namespace palpate::recording
