// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/system_facts.hpp"

#include <algorithm>
#include <charconv>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

/// The text of a scalar; empty where there is none, or it has a variable of the file, "$(name)".
std::string TextOf(const ConfigNode& map, const std::string& key) {
  const ConfigNode* node = map.Find(key);
  if (node == nullptr || node->kind != ConfigNode::Kind::kScalar) return {};
  return node->text.find("$(") == node->text.npos ? node->text : std::string();
}

std::vector<ConfigNode> ItemsOf(const ConfigNode& map, const std::string& key) {
  const ConfigNode* node = map.Find(key);
  return node == nullptr ? std::vector<ConfigNode>() : node->items;
}

const ConfigNode& ThisHost(const ConfigNode& root, const std::vector<ConfigNode>& hosts,
                           const std::string& host, const std::vector<std::string>& own_names) {
  std::vector<std::string> names;
  for (const ConfigNode& one : hosts) {
    names.push_back(TextOf(one, "name"));
    const auto is_own = [&](const std::string& name) {
      return std::find(own_names.begin(), own_names.end(), name) != own_names.end();
    };
    const bool chosen = host.empty() ? is_own(names.back()) || is_own(TextOf(one, "address"))
                                     : names.back() == host;
    if (chosen || (host.empty() && hosts.size() == 1)) return one;
  }
  const ConfigNode* list = root.Find("hosts");
  if (!host.empty()) Refuse(*list, "has no host '" + host + "'" + DidYouMean(host, names));
  Refuse(*list, "none of the hosts is this one: give --host, one of " + Listed(names));
}

void ReadProcess(const ConfigNode& process, const std::filesystem::path& folder,
                 SystemFacts* facts) {
  const std::string component = TextOf(process, "component");
  const ConfigNode* set = process.Find("set");
  const std::string source = set == nullptr ? std::string() : TextOf(*set, "source");
  if (component == "capture") facts->has_genicam_camera = source.empty() || source == "genicam";
  if (component != "force_estimation") return;
  std::vector<std::string> words;
  for (const ConfigNode& word : ItemsOf(process, "arguments")) words.push_back(word.text);
  const auto place = [&](const std::string& file) {
    const bool is_beside = std::filesystem::exists(folder / file);
    return is_beside ? folder / file : std::filesystem::path(file);
  };
  const auto is_known = [](const std::string& word) { return word.find("$(") == word.npos; };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_robot = i == 0 && !words[i].starts_with('-');
    const bool is_calibration = i > 0 && words[i - 1] == "--calibration";
    if (is_robot && is_known(words[i])) facts->robot = place(words[i]);
    if (is_calibration && is_known(words[i])) facts->calibration = place(words[i]);
  }
}

}  // namespace

SystemFacts ReadSystemFacts(const ConfigNode& root, const std::string& host,
                            const std::vector<std::string>& own_names) {
  SystemFacts facts;
  const std::filesystem::path folder = std::filesystem::path(root.where.file).parent_path();
  const std::string domain = TextOf(root, "domain");
  int id = 0;
  const auto [end, error] = std::from_chars(domain.data(), domain.data() + domain.size(), id);
  if (error == std::errc()) facts.domain_id = id;
  facts.transport = TextOf(root, "transport");
  const std::string security = TextOf(root, "security");
  if (!security.empty()) facts.security = folder / security;
  for (const ConfigNode& peer : ItemsOf(root, "peers")) facts.peers.push_back(peer.text);
  const std::vector<ConfigNode> hosts = ItemsOf(root, "hosts");
  if (hosts.empty()) return facts;
  const ConfigNode& own = ThisHost(root, hosts, host, own_names);
  facts.network_interface = TextOf(own, "interface");
  for (const ConfigNode& other : hosts) {
    const std::string address = TextOf(other, "address");
    if (&other != &own && !address.empty()) facts.peers.push_back(address);
  }
  bool has_virtual_camera = false;
  for (const ConfigNode& process : ItemsOf(own, "processes")) {
    ReadProcess(process, folder, &facts);
    has_virtual_camera = has_virtual_camera || TextOf(process, "component") == "virtual_camera";
  }
  // It is there once the system runs.
  if (has_virtual_camera) facts.has_genicam_camera = false;
  return facts;
}

}  // namespace palpate::command
