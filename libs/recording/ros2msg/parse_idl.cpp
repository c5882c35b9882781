// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <regex>

#include "libs/core/error.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recording {

namespace {

/// After the mapping of ROS 2 (docs/architecture.md, "DDS conventions").
std::string RosTypeOf(const std::string& idl_type) {
  static const std::map<std::string, std::string> kTypes{
      {"boolean", "bool"},         {"octet", "uint8"},           {"char", "uint8"},
      {"short", "int16"},          {"unsigned short", "uint16"}, {"long", "int32"},
      {"unsigned long", "uint32"}, {"long long", "int64"},       {"unsigned long long", "uint64"},
      {"float", "float32"},        {"double", "float64"},        {"string", "string"}};
  if (const auto known = kTypes.find(idl_type); known != kTypes.end()) return known->second;
  static const std::regex kMessage(R"(([a-z0-9_]+)::msg::dds_::([A-Za-z0-9]+)_)");
  std::smatch match;
  if (std::regex_match(idl_type, match, kMessage)) return match[1].str() + "/" + match[2].str();
  return {};
}

/// IDL escapes names that are words of its own, or that C would not take.
std::string WithoutEscape(std::string name) {
  if (name.starts_with('_')) name.erase(0, 1);
  return name;
}

class IdlParser {
 public:
  IdlParser(std::string_view text, const std::string& file) : file_(file) {
    static const std::regex kComment(R"(//[^\n]*|#[^\n]*)");
    text_ = std::regex_replace(std::string(text), kComment, "");
  }

  MessageDefinition Run() && {
    static const std::regex kHead(R"(^\s*module\s+(\w+)\s*\{)");
    static const std::regex kStruct(R"(struct\s+(\w+)_\s*\{([^}]*)\})");
    static const std::regex kConstant(R"(const\s+([\w ]+?)\s+(\w+)\s*=\s*([^;]+?)\s*;)");
    std::smatch package;
    std::smatch body;
    if (!std::regex_search(text_, package, kHead) || !std::regex_search(text_, body, kStruct)) {
      Refuse("holds no struct of a module");
    }
    MessageDefinition definition{package[1].str() + "/" + body[1].str(), {}, {}};
    for (std::sregex_iterator it(text_.begin(), text_.end(), kConstant), end; it != end; ++it) {
      definition.constants.push_back({Known((*it)[1]), WithoutEscape((*it)[2]), (*it)[3].str()});
    }
    definition.fields = Fields(body[2]);
    return definition;
  }

 private:
  [[noreturn]] void Refuse(const std::string& message) const { throw InputError({file_}, message); }

  std::string Known(const std::string& idl_type) const {
    std::string type = RosTypeOf(idl_type);
    if (type.empty()) Refuse("type '" + idl_type + "' has no counterpart in ROS 2 messages");
    return type;
  }

  std::vector<Field> Fields(const std::string& body) const {
    static const std::regex kField(
        R"(\s*(sequence<\s*)?([\w: ]+?)(\s*>)?\s+(\w+)(\[(\d+)\])?\s*;)");
    std::vector<Field> fields;
    std::string::const_iterator at = body.begin();
    std::smatch match;
    while (
        std::regex_search(at, body.end(), match, kField, std::regex_constants::match_continuous)) {
      Field field{Known(match[2]), WithoutEscape(match[4]), Repeat::kOne, 0};
      if (match[1].matched) field.repeat = Repeat::kSequence;
      if (match[5].matched) {
        field.repeat = Repeat::kFixed;
        field.count = static_cast<std::uint32_t>(std::stoul(match[6]));
      }
      fields.push_back(std::move(field));
      at = match.suffix().first;
    }
    const std::string rest(at, body.end());
    if (rest.find_first_not_of(" \t\n") != rest.npos) Refuse("cannot be read at '" + rest + "'");
    return fields;
  }

  std::string file_;
  std::string text_;
};

}  // namespace

MessageDefinition ParseIdl(std::string_view text, const std::string& file) {
  return IdlParser(text, file).Run();
}

}  // namespace palpate::recording
