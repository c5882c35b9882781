// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "components/palpate/security/manifest.hpp"
#include "libs/security/certificates.hpp"
#include "libs/security/permissions.hpp"

namespace palpate::command {

/// What an identity may write and read. Throws InputError for a role that there is not.
using RightsOfIdentity = std::function<security::AccessRights(const Identity&)>;

/// The authorities of a secured system and all it has issued, in the layout of ROS 2's keystores:
///
///   manifest.json
///   private/{identity_ca,permissions_ca}.key.pem   stay on this host
///   public/{identity_ca,permissions_ca}.cert.pem, crl.pem
///   enclaves/NAME/                                 goes to the host of NAME (security::Material)
class Keystore {
 public:
  /// Makes both authorities. Throws InputError where `folder` is there and not empty, RunError
  /// where it cannot be written.
  static Keystore Create(const std::filesystem::path& folder, std::int64_t now_s);

  /// Opens one. Throws InputError where it is none.
  explicit Keystore(const std::filesystem::path& folder);

  /// Issues certificate, key and permissions for each. One that is there already gets new ones.
  /// Throws InputError for names that are none and for two of one name.
  void Enroll(const std::vector<Identity>& identities, const RightsOfIdentity& rights, int days,
              std::int64_t now_s);

  /// Revokes each: removes its files and adds its certificate to the revocation list that all
  /// others have. Throws InputError, with "did you mean", for a name that is not enrolled.
  void Revoke(const std::vector<std::string>& names, std::int64_t now_s);

  /// Notes that a host was seen with the files of now.
  void NoteHost(const std::string& host);

  const std::filesystem::path& folder() const { return folder_; }
  const Manifest& manifest() const { return manifest_; }

  /// Hosts whose files were changed since NoteHost() has seen them, sorted.
  std::vector<std::string> OutdatedHosts() const;

 private:
  Keystore(std::filesystem::path folder, Manifest manifest);

  security::Credentials Authority(const std::string& name) const;
  /// Makes the list where it is missing, and gives it to each identity.
  void ShareRevocationList(std::int64_t now_s) const;

  std::filesystem::path folder_;
  Manifest manifest_;
};

/// Refuses a name of an identity that is none. Throws InputError.
void CheckIdentityName(const std::string& name);

}  // namespace palpate::command
