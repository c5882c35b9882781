// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/security/keystore.hpp"
#include "libs/security/material.hpp"

namespace palpate::command {

/// One identity and what is wrong with it; nothing: it can start.
struct IdentityState {
  std::string name;
  std::string role;  ///< empty where no manifest says it
  std::string host;
  std::int64_t end_s = 0;  ///< of its certificate, s since 1970; 0: not known
  std::vector<security::Finding> findings;
};

struct KeystoreState {
  std::vector<IdentityState> identities;
  std::vector<security::Finding> findings;  ///< of the keystore as a whole
  std::vector<std::string> outdated_hosts;
  std::vector<std::string> revoked;  ///< names

  bool IsSound() const;  ///< no error; outdated hosts are none
};

/// Checks the identities in a folder with enclaves/, such as a host has: all of them, or those of
/// `names`. Throws InputError where there is none at all.
KeystoreState CheckHostFiles(const std::filesystem::path& folder,
                             const std::vector<std::string>& names, std::int64_t now_s);

/// The same for a keystore, and whether its own keys are kept from others, and permissions are
/// those of `rights`.
KeystoreState CheckKeystore(const Keystore& keystore, const std::vector<std::string>& names,
                            const RightsOfIdentity& rights, std::int64_t now_s);

/// What differs between the keystore and the files of a host, which are at `copy`: missing, old,
/// revoked, and of other hosts.
std::vector<security::Finding> CompareWithHost(const Keystore& keystore, const std::string& host,
                                               const std::filesystem::path& copy);

/// What the wanted identities of a system lack in the keystore: not enrolled, another role or host.
std::vector<security::Finding> CompareWithSystem(const Keystore& keystore,
                                                 const std::vector<Identity>& wanted);

}  // namespace palpate::command
