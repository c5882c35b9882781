// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/wanted_identities.hpp"

#include <set>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

std::string TextAt(const ConfigNode& map, const std::string& key) {
  const ConfigNode* node = map.Find(key);
  return node == nullptr ? "" : ReadText(*node);
}

std::vector<std::string> TextsAt(const ConfigNode& map, const std::string& key) {
  std::vector<std::string> texts;
  const ConfigNode* list = map.Find(key);
  if (list == nullptr) return texts;
  for (const ConfigNode& item : list->items) texts.push_back(ReadText(item));
  return texts;
}

const std::vector<ConfigNode>& ItemsAt(const ConfigNode& map, const std::string& key) {
  const ConfigNode* list = map.Find(key);
  if (list == nullptr || list->kind != ConfigNode::Kind::kList) {
    Refuse(map, "needs '" + key + "', a list (docs of `palpate launch`)");
  }
  return list->items;
}

Identity IdentityOf(const ConfigNode& process, const std::string& component) {
  Identity identity{.name = component, .role = component, .host = {}, .remap = {}};
  const ConfigNode* settings = process.Find("set");
  if (settings != nullptr) {
    const std::string name = TextAt(*settings, "dds.identity");
    const std::string node_namespace = TextAt(*settings, "dds.node_namespace");
    if (!name.empty()) identity.name = name;
    if (!node_namespace.empty()) identity.node_namespace = node_namespace;
  }
  const ConfigNode* environment = process.Find("environment");
  if (environment != nullptr) {
    const std::string name = TextAt(*environment, "PALPATE_SECURITY_IDENTITY");
    if (!name.empty()) identity.name = name;
  }
  identity.remap = TextsAt(process, "remap");
  return identity;
}

}  // namespace

Identity ParseIdentity(const std::string& text) {
  Identity identity;
  std::string rest = text;
  const std::size_t at = rest.find('@');
  if (at != rest.npos) {
    identity.host = rest.substr(at + 1);
    rest.erase(at);
    if (identity.host.empty()) throw InputError("'" + Excerpt(text) + "': a host after '@'");
  }
  const std::size_t equals = rest.find('=');
  identity.name = rest.substr(0, equals);
  identity.role = equals == rest.npos ? identity.name : rest.substr(equals + 1);
  if (identity.name.empty() || identity.role.empty()) {
    throw InputError("'" + Excerpt(text) +
                     "' must be written as NAME[=ROLE][@HOST], like capture@camera_host");
  }
  return identity;
}

std::vector<Identity> IdentitiesOfSystem(const ConfigNode& system) {
  const std::string node_namespace = TextAt(system, "namespace");
  std::vector<Identity> identities;
  std::set<std::string> names;
  for (const ConfigNode& host : ItemsAt(system, "hosts")) {
    for (const ConfigNode& process : ItemsAt(host, "processes")) {
      const std::string component = TextAt(process, "component");
      if (component.empty()) continue;  // another program
      Identity identity = IdentityOf(process, component);
      identity.host = TextAt(host, "name");
      if (identity.node_namespace == "/" && !node_namespace.empty()) {
        identity.node_namespace = node_namespace;
      }
      if (!names.insert(identity.name).second) {
        Refuse(process, "is a second process with the identity '" + identity.name +
                            "': give it one of its own, set: {dds.identity: NAME}");
      }
      identities.push_back(identity);
    }
  }
  return identities;
}

}  // namespace palpate::command
