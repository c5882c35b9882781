// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/manifest.hpp"

#include <nlohmann/json.hpp>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path FileOf(const std::filesystem::path& keystore) {
  return keystore / "manifest.json";
}

Json ToJson(const EnrolledIdentity& enrolled) {
  return {{"role", enrolled.identity.role},
          {"host", enrolled.identity.host},
          {"namespace", enrolled.identity.node_namespace},
          {"remap", enrolled.identity.remap},
          {"serial", enrolled.serial_hex}};
}

EnrolledIdentity FromJson(const std::string& name, const Json& json) {
  return {{.name = name,
           .role = json.at("role"),
           .host = json.at("host"),
           .node_namespace = json.at("namespace"),
           .remap = json.at("remap")},
          json.at("serial")};
}

}  // namespace

Manifest ReadManifest(const std::filesystem::path& keystore) {
  const std::filesystem::path file = FileOf(keystore);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw InputError({keystore.string()},
                     "is no keystore: it has no manifest.json; palpate security init makes one");
  }
  try {
    const Json json = Json::parse(ReadFile(file));
    Manifest manifest;
    manifest.version = json.at("version");
    for (const auto& [name, entry] : json.at("identities").items()) {
      manifest.identities.emplace(name, FromJson(name, entry));
    }
    manifest.revoked = json.at("revoked");
    for (const auto& [host, state] : json.at("hosts").items()) {
      manifest.hosts[host] = {state.at("needed"), state.at("seen")};
    }
    return manifest;
  } catch (const Json::exception& exception) {
    throw InputError({file.string()}, std::string("is no manifest: ") + exception.what());
  }
}

void WriteManifest(const std::filesystem::path& keystore, const Manifest& manifest) {
  Json json{{"version", manifest.version},
            {"identities", Json::object()},
            {"revoked", manifest.revoked},
            {"hosts", Json::object()}};
  for (const auto& [host, state] : manifest.hosts) {
    json["hosts"][host] = {{"needed", state.needed}, {"seen", state.seen}};
  }
  for (const auto& [name, enrolled] : manifest.identities) {
    json["identities"][name] = ToJson(enrolled);
  }
  WriteFile(FileOf(keystore), json.dump(2) + "\n");
}

}  // namespace palpate::command
