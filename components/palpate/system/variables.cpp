// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/system/variables.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/names.hpp"

namespace palpate::command {

namespace {

constexpr char kFolder[] = "dirname";

std::vector<std::string> NamesOf(const SystemVariables& variables) {
  std::vector<std::string> names;
  for (const auto& [name, unused] : variables) names.push_back(name);
  return names;
}

/// `text` with the values in place of their names.
std::string Substituted(const ConfigNode& node, const SystemVariables& values) {
  std::string text;
  std::size_t from = 0;
  for (std::size_t at = 0; (at = node.text.find("$(", from)) != std::string::npos;) {
    const std::size_t end = node.text.find(')', at);
    if (end == std::string::npos) Refuse(node, "'$(' has no ')'");
    const std::string name = node.text.substr(at + 2, end - at - 2);
    const auto found = values.find(name);
    if (found == values.end()) Refuse(node, Unknown("variable", name, NamesOf(values)));
    text += node.text.substr(from, at - from) + found->second;
    from = end + 1;
  }
  return text + node.text.substr(from);
}

/// Each may use those above it; `given` replace those of the file.
SystemVariables OfFile(const ConfigNode& root, const SystemVariables& given) {
  SystemVariables values;
  const std::filesystem::path file = std::filesystem::absolute(root.where.file);
  values[kFolder] = file.lexically_normal().parent_path().string();
  const ConfigNode* variables = root.Find("variables");
  if (variables == nullptr) return values;
  for (const auto& [name, value] : variables->entries) {
    if (name == kFolder) Refuse(value, "is the folder of the file, and cannot be set");
    if (value.kind != ConfigNode::Kind::kScalar) Refuse(value, "must be a text or a number");
    const auto replaced = given.find(name);
    values[name] = replaced == given.end() ? Substituted(value, values) : replaced->second;
  }
  return values;
}

void Substitute(const SystemVariables& values, ConfigNode* node) {
  for (ConfigNode& item : node->items) Substitute(values, &item);
  for (ConfigEntry& entry : node->entries) Substitute(values, &entry.value);
  if (node->kind == ConfigNode::Kind::kScalar) node->text = Substituted(*node, values);
}

}  // namespace

void SubstituteVariables(ConfigNode* root, const SystemVariables& given) {
  const SystemVariables values = OfFile(*root, given);
  for (const auto& [name, value] : given) {
    if (name == kFolder || !values.contains(name)) {
      throw InputError(name + ":=" + value + ": " + Unknown("variable", name, NamesOf(values)) +
                       "; the key 'variables' of " + root->where.file + " names them");
    }
  }
  for (ConfigEntry& entry : root->entries) {
    if (entry.key != "variables") Substitute(values, &entry.value);
  }
}

}  // namespace palpate::command
