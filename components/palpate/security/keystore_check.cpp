// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/keystore_check.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/security/permissions.hpp"
#include "libs/security/signed_document.hpp"

namespace palpate::command {

namespace {

using security::Finding;
using Path = std::filesystem::path;

constexpr std::array<std::string_view, 7> kFiles{
    "cert.pem", "crl.pem",         "governance.p7s",         "identity_ca.cert.pem",
    "key.pem",  "permissions.p7s", "permissions_ca.cert.pem"};

bool HasError(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

std::vector<std::string> NamesIn(const Path& enclaves) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(enclaves, error)) {
    if (entry.is_directory(error)) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

IdentityState StateOf(const Path& folder, const std::string& name, std::int64_t now_s) {
  const security::Material material = security::MaterialOf(folder, name);
  IdentityState state{.name = name, .role = {}, .host = {}, .findings = {}};
  state.findings = security::CheckMaterial(material, now_s);
  try {
    state.end_s = security::ReadCertificate(ReadFile(material.certificate)).valid.end_s;
  } catch (const InputError&) {
    // A finding says so.
  }
  return state;
}

std::string Difference(const std::vector<std::string>& has, const std::vector<std::string>& wants) {
  std::vector<std::string> more;
  std::vector<std::string> less;
  std::set_difference(has.begin(), has.end(), wants.begin(), wants.end(), std::back_inserter(more));
  std::set_difference(wants.begin(), wants.end(), has.begin(), has.end(), std::back_inserter(less));
  std::string text;
  if (!more.empty()) text += "has " + Listed(more);
  if (!less.empty()) text += (text.empty() ? "lacks " : ", lacks ") + Listed(less);
  return text;
}

/// Permissions against the table of topics.
void CompareRights(const Path& folder, const Identity& identity, const RightsOfIdentity& rights,
                   std::vector<Finding>* findings) {
  const security::Material material = security::MaterialOf(folder, identity.name);
  const std::string remedy = "palpate security enroll " + folder.string() + " " + identity.name;
  const auto has = security::ReadRights(security::VerifiedDocument(
      ReadFile(material.permissions), ReadFile(material.permissions_authority)));
  security::AccessRights wants = rights(identity);
  std::sort(wants.write.begin(), wants.write.end());
  std::sort(wants.read.begin(), wants.read.end());
  const std::string write = Difference(has.write, wants.write);
  const std::string read = Difference(has.read, wants.read);
  if (!write.empty()) {
    findings->push_back({Severity::kError, material.permissions, "for writing " + write, remedy});
  }
  if (!read.empty()) {
    findings->push_back({Severity::kError, material.permissions, "for reading " + read, remedy});
  }
}

void CheckOwnKeys(const Path& folder, std::vector<Finding>* findings) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "private", error)) {
    struct stat status {};
    if (stat(entry.path().c_str(), &status) != 0) continue;
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) == 0) continue;
    findings->push_back({Severity::kError, entry.path(),
                         "other users may read the key of an authority",
                         "chmod 600 " + entry.path().string()});
  }
}

bool AreEqual(const Path& a, const Path& b) {
  try {
    return ReadFile(a) == ReadFile(b);
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

bool KeystoreState::IsSound() const {
  return !HasError(findings) &&
         std::none_of(identities.begin(), identities.end(),
                      [](const IdentityState& state) { return HasError(state.findings); });
}

KeystoreState CheckHostFiles(const Path& folder, const std::vector<std::string>& names,
                             std::int64_t now_s) {
  KeystoreState state;
  const std::vector<std::string> all = names.empty() ? NamesIn(folder / "enclaves") : names;
  if (all.empty()) {
    throw InputError({folder.string()},
                     "has no identities: a keystore, or the folder of a host, holds enclaves/NAME");
  }
  for (const std::string& name : all) state.identities.push_back(StateOf(folder, name, now_s));
  return state;
}

KeystoreState CheckKeystore(const Keystore& keystore, const std::vector<std::string>& names,
                            const RightsOfIdentity& rights, std::int64_t now_s) {
  KeystoreState state = CheckHostFiles(keystore.folder(), names, now_s);
  for (IdentityState& identity : state.identities) {
    const auto found = keystore.manifest().identities.find(identity.name);
    if (found == keystore.manifest().identities.end()) continue;
    identity.role = found->second.identity.role;
    identity.host = found->second.identity.host;
    if (HasError(identity.findings)) continue;
    CompareRights(keystore.folder(), found->second.identity, rights, &identity.findings);
  }
  CheckOwnKeys(keystore.folder(), &state.findings);
  state.outdated_hosts = keystore.OutdatedHosts();
  for (const auto& [serial, name] : keystore.manifest().revoked) state.revoked.push_back(name);
  std::sort(state.revoked.begin(), state.revoked.end());
  return state;
}

std::vector<Finding> CompareWithHost(const Keystore& keystore, const std::string& host,
                                     const Path& copy) {
  std::vector<Finding> findings;
  const auto add = [&](const Path& file, const std::string& problem, const std::string& remedy) {
    findings.push_back({Severity::kError, file, problem, remedy});
  };
  std::set<std::string> wanted;
  for (const auto& [name, enrolled] : keystore.manifest().identities) {
    if (enrolled.identity.host != host) continue;
    wanted.insert(name);
    const Path ours = security::MaterialOf(keystore.folder(), name).folder;
    const Path theirs = security::MaterialOf(copy, name).folder;
    const std::string remedy = "copy " + ours.string() + " to host " + host;
    std::error_code error;
    if (!std::filesystem::is_directory(theirs, error)) {
      add(theirs, "is missing on host " + host, remedy);
      continue;
    }
    for (const std::string_view file : kFiles) {
      if (!AreEqual(ours / file, theirs / file)) {
        add(theirs / file, "is not that of the keystore", remedy);
      }
    }
  }
  for (const std::string& name : NamesIn(copy / "enclaves")) {
    if (wanted.contains(name)) continue;
    const Path theirs = security::MaterialOf(copy, name).folder;
    const bool enrolled = keystore.manifest().identities.contains(name);
    add(theirs, enrolled ? "belongs to another host" : "was revoked, or is not of this keystore",
        "rm -r " + theirs.string());
  }
  if (std::filesystem::exists(copy / "private")) {
    add(copy / "private", "keys of the authorities are on host " + host,
        "rm -r " + (copy / "private").string());
  }
  return findings;
}

std::vector<Finding> CompareWithSystem(const Keystore& keystore,
                                       const std::vector<Identity>& wanted) {
  std::vector<Finding> findings;
  for (const Identity& identity : wanted) {
    const auto found = keystore.manifest().identities.find(identity.name);
    const std::string remedy =
        "palpate security enroll " + keystore.folder().string() + " --system FILE";
    std::string problem;
    if (found == keystore.manifest().identities.end()) {
      problem = "is not enrolled";
    } else if (found->second.identity.role != identity.role) {
      problem = "has the rights of " + found->second.identity.role + ", the system file has " +
                identity.role;
    } else if (found->second.identity.host != identity.host) {
      problem = "belongs to host '" + found->second.identity.host + "', the system file has '" +
                identity.host + "'";
    } else if (found->second.identity.node_namespace != identity.node_namespace ||
               found->second.identity.remap != identity.remap) {
      problem = "has other names of topics than the system file";
    }
    if (problem.empty()) continue;
    findings.push_back({Severity::kError,
                        security::MaterialOf(keystore.folder(), identity.name).folder, problem,
                        remedy});
  }
  return findings;
}

}  // namespace palpate::command
