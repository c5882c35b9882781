// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/keystore.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/security/material.hpp"
#include "libs/security/signed_document.hpp"

namespace palpate::command {

namespace {

using Path = std::filesystem::path;

constexpr std::int64_t kDay_s = 24 * 3600;
/// Of authorities and revocation lists: the life of a robot.
constexpr std::int64_t kAuthorityDays = 20 * 365;
/// Hosts whose clock is behind accept what is new, too.
constexpr std::int64_t kBackdated_s = kDay_s;
constexpr char kIdentityAuthority[] = "identity_ca";
constexpr char kPermissionsAuthority[] = "permissions_ca";
constexpr auto kOwnerOnly = std::filesystem::perms::owner_all;

security::Period PeriodOf(std::int64_t days, std::int64_t now_s) {
  return {now_s - kBackdated_s, now_s + days * kDay_s};
}

void MakeFolder(const Path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) std::filesystem::permissions(folder, kOwnerOnly, error);
  if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
}

/// A file that only its owner can read, from its first byte on.
void WriteSecret(const Path& file, const std::string& text) {
  Path whole = file;
  whole += ".part" + std::to_string(getpid());
  const int handle = open(whole.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool written =
      handle >= 0 && write(handle, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const std::string cause = std::strerror(errno);
  const bool closed = handle >= 0 && close(handle) == 0;
  std::error_code error;
  if (written && closed) std::filesystem::rename(whole, file, error);
  if (written && closed && !error) return;
  std::filesystem::remove(whole, error);
  throw RunError(file.string() + ": cannot be written: " + cause);
}

Path CertificateFile(const Path& folder, const std::string& authority) {
  return folder / "public" / (authority + ".cert.pem");
}

Path KeyFile(const Path& folder, const std::string& authority) {
  return folder / "private" / (authority + ".key.pem");
}

Path RevocationListFile(const Path& folder) { return folder / "public" / "crl.pem"; }

void WriteAuthority(const Path& folder, const std::string& authority,
                    const security::Credentials& credentials) {
  WriteFile(CertificateFile(folder, authority), credentials.certificate_pem);
  WriteSecret(KeyFile(folder, authority), credentials.private_key_pem);
}

}  // namespace

void CheckIdentityName(const std::string& name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (!name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), fits)) return;
  throw InputError("'" + Excerpt(name) +
                   "' is no name of an identity (like left_capture: letters, digits, _; at most "
                   "64)");
}

Keystore::Keystore(Path folder, Manifest manifest)
    : folder_(std::move(folder)), manifest_(std::move(manifest)) {}

Keystore::Keystore(const Path& folder) : Keystore(folder, ReadManifest(folder)) {}

Keystore Keystore::Create(const Path& folder, std::int64_t now_s) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_empty(folder, error)) {
    throw InputError({folder.string()},
                     "is there already: give a new folder, or `palpate security enroll` to add to "
                     "this keystore");
  }
  for (const char* part : {"", "public", "private", "enclaves"}) MakeFolder(folder / part);
  const security::Period valid = PeriodOf(kAuthorityDays, now_s);
  WriteAuthority(
      folder, kIdentityAuthority,
      security::CreateAuthority("palpate identities", security::AuthorityUse::kIdentities, valid));
  WriteAuthority(
      folder, kPermissionsAuthority,
      security::CreateAuthority("palpate permissions", security::AuthorityUse::kDocuments, valid));
  WriteManifest(folder, {});
  return Keystore(folder);
}

security::Credentials Keystore::Authority(const std::string& name) const {
  return {ReadFile(CertificateFile(folder_, name)), ReadFile(KeyFile(folder_, name))};
}

void Keystore::Enroll(const std::vector<Identity>& identities, const RightsOfIdentity& rights,
                      int days, std::int64_t now_s) {
  std::set<std::string> names;
  std::vector<security::AccessRights> rights_of;
  for (const Identity& identity : identities) {
    CheckIdentityName(identity.name);
    if (!names.insert(identity.name).second) {
      throw InputError("identity '" + identity.name + "' is given twice: give each a name");
    }
    rights_of.push_back(rights(identity));
  }
  const security::Credentials identity_authority = Authority(kIdentityAuthority);
  const security::Credentials permissions_authority = Authority(kPermissionsAuthority);
  const security::Period valid = PeriodOf(days, now_s);
  const std::string governance =
      security::SignDocument(security::GovernanceXml(), permissions_authority);
  ++manifest_.version;
  for (std::size_t i = 0; i < identities.size(); ++i) {
    const Identity& identity = identities[i];
    const security::Material files = security::MaterialOf(folder_, identity.name);
    const security::Credentials own =
        security::IssueIdentity(identity_authority, identity.name, valid);
    MakeFolder(files.folder);
    WriteFile(files.identity_authority, identity_authority.certificate_pem);
    WriteFile(files.permissions_authority, permissions_authority.certificate_pem);
    WriteFile(files.governance, governance);
    const std::string permissions = security::PermissionsXml(identity.name, rights_of[i], valid);
    WriteFile(files.permissions, security::SignDocument(permissions, permissions_authority));
    WriteFile(files.certificate, own.certificate_pem);
    WriteSecret(files.private_key, own.private_key_pem);
    const auto known = manifest_.identities.find(identity.name);
    if (known != manifest_.identities.end() && !known->second.identity.host.empty()) {
      manifest_.hosts[known->second.identity.host].needed = manifest_.version;
    }
    manifest_.identities.insert_or_assign(
        identity.name,
        EnrolledIdentity{identity, security::ReadCertificate(own.certificate_pem).serial_hex});
    if (!identity.host.empty()) manifest_.hosts[identity.host].needed = manifest_.version;
  }
  ShareRevocationList(now_s);
  WriteManifest(folder_, manifest_);
}

void Keystore::Revoke(const std::vector<std::string>& names, std::int64_t now_s) {
  std::vector<std::string> enrolled;
  for (const auto& [name, entry] : manifest_.identities) enrolled.push_back(name);
  for (const std::string& name : names) {
    if (manifest_.identities.contains(name)) continue;
    throw InputError("'" + Excerpt(name) + "' is not enrolled in " + folder_.string() +
                     DidYouMean(name, enrolled));
  }
  ++manifest_.version;
  for (const std::string& name : names) {
    const auto found = manifest_.identities.find(name);
    if (found == manifest_.identities.end()) continue;  // named twice
    manifest_.revoked[found->second.serial_hex] = name;
    manifest_.identities.erase(found);
    std::error_code error;
    std::filesystem::remove_all(security::MaterialOf(folder_, name).folder, error);
    if (error) throw RunError(folder_.string() + ": cannot be changed: " + error.message());
  }
  for (auto& [host, state] : manifest_.hosts) state.needed = manifest_.version;
  std::error_code error;
  std::filesystem::remove(RevocationListFile(folder_), error);
  ShareRevocationList(now_s);
  WriteManifest(folder_, manifest_);
}

void Keystore::ShareRevocationList(std::int64_t now_s) const {
  const Path common = RevocationListFile(folder_);
  std::error_code error;
  if (!std::filesystem::exists(common, error)) {
    std::vector<std::string> serials;
    for (const auto& [serial, name] : manifest_.revoked) serials.push_back(serial);
    WriteFile(common,
              security::MakeRevocationList(Authority(kIdentityAuthority), serials,
                                           manifest_.version, PeriodOf(kAuthorityDays, now_s)));
  }
  const std::string list = ReadFile(common);
  for (const auto& [name, entry] : manifest_.identities) {
    WriteFile(security::MaterialOf(folder_, name).folder / "crl.pem", list);
  }
}

void Keystore::NoteHost(const std::string& host) {
  manifest_.hosts[host].seen = manifest_.version;
  WriteManifest(folder_, manifest_);
}

std::vector<std::string> Keystore::OutdatedHosts() const {
  std::vector<std::string> outdated;
  for (const auto& [host, state] : manifest_.hosts) {
    if (state.seen < state.needed) outdated.push_back(host);
  }
  return outdated;
}

}  // namespace palpate::command
