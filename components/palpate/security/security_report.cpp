// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/security_report.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "libs/core/text.hpp"
#include "libs/core/utc_text.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

const char* Word(Severity severity) { return severity == Severity::kWarning ? "warning" : "error"; }

std::string LineOf(const security::Finding& finding) {
  return fmt::format("  {}: {}\n", Word(finding.severity), finding.ToString());
}

Json ToJson(const std::vector<security::Finding>& findings) {
  Json list = Json::array();
  for (const security::Finding& finding : findings) {
    list.push_back({{"severity", Word(finding.severity)},
                    {"file", finding.file.string()},
                    {"problem", finding.problem},
                    {"remedy", finding.remedy}});
  }
  return list;
}

std::map<std::string, std::vector<std::string>> NamesByHost(const Keystore& keystore) {
  std::map<std::string, std::vector<std::string>> names;
  for (const auto& [name, enrolled] : keystore.manifest().identities) {
    if (!enrolled.identity.host.empty()) names[enrolled.identity.host].push_back(name);
  }
  return names;
}

}  // namespace

std::string CheckText(const KeystoreState& state) {
  std::string text;
  for (const IdentityState& identity : state.identities) {
    text += identity.name;
    if (!identity.role.empty() && identity.role != identity.name)
      text += " (" + identity.role + ")";
    if (!identity.host.empty()) text += " on " + identity.host;
    text += identity.findings.empty() ? ": ok" : ":";
    if (identity.end_s > 0) text += " valid to " + UtcText(identity.end_s);
    text += "\n";
    for (const security::Finding& finding : identity.findings) text += LineOf(finding);
  }
  for (const security::Finding& finding : state.findings) text += LineOf(finding);
  if (!state.revoked.empty()) text += "revoked: " + Listed(state.revoked) + "\n";
  if (!state.outdated_hosts.empty()) {
    text += "hosts not seen with the files of now: " + Listed(state.outdated_hosts) +
            " (check with --host HOST=PATH)\n";
  }
  return text;
}

std::string CheckJson(const KeystoreState& state) {
  Json json{{"sound", state.IsSound()},
            {"identities", Json::array()},
            {"findings", ToJson(state.findings)},
            {"outdated_hosts", state.outdated_hosts},
            {"revoked", state.revoked}};
  for (const IdentityState& identity : state.identities) {
    Json entry{{"name", identity.name}, {"role", identity.role}, {"host", identity.host}};
    entry["valid_to"] = identity.end_s > 0 ? Json(UtcText(identity.end_s)) : Json();
    entry["findings"] = ToJson(identity.findings);
    json["identities"].push_back(std::move(entry));
  }
  return json.dump(2) + "\n";
}

std::string CopyText(const Keystore& keystore) {
  std::string text;
  for (const auto& [host, names] : NamesByHost(keystore)) {
    // As a shell takes it.
    text +=
        fmt::format("  host {}: {}/enclaves/{}\n", host, keystore.folder().string(),
                    names.size() == 1 ? names[0] : fmt::format("{{{}}}", fmt::join(names, ",")));
  }
  return text.empty() ? text : "copy to the hosts, and nothing else:\n" + text;
}

std::string OutdatedText(const Keystore& keystore) {
  const std::vector<std::string> hosts = keystore.OutdatedHosts();
  if (hosts.empty()) return {};
  std::string text = "hosts that still have the old files:\n";
  const auto names = NamesByHost(keystore);
  for (const std::string& host : hosts) {
    const auto found = names.find(host);
    text += fmt::format("  {}: {}\n", host,
                        found == names.end() ? "remove all of enclaves/"
                                             : "copy enclaves/ of " + Listed(found->second));
  }
  return text + "A revoked identity is refused by each process that starts with the new files.\n";
}

std::string KeystoreJson(const Keystore& keystore) {
  Json json{{"keystore", keystore.folder().string()},
            {"version", keystore.manifest().version},
            {"identities", Json::array()},
            {"outdated_hosts", keystore.OutdatedHosts()}};
  for (const auto& [name, enrolled] : keystore.manifest().identities) {
    json["identities"].push_back({{"name", name},
                                  {"role", enrolled.identity.role},
                                  {"host", enrolled.identity.host},
                                  {"serial", enrolled.serial_hex}});
  }
  return json.dump(2) + "\n";
}

}  // namespace palpate::command
