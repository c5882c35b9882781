// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/security/keystore.hpp"
#include "components/palpate/security/keystore_check.hpp"

namespace palpate::command {

/// What `palpate security check` prints: a line for each identity, one for each finding.
std::string CheckText(const KeystoreState& state);
std::string CheckJson(const KeystoreState& state);

/// Which files go to which host; "" where no identity has a host.
std::string CopyText(const Keystore& keystore);

/// After a revocation: which hosts still have the old files.
std::string OutdatedText(const Keystore& keystore);

/// The keystore as it is now: version, identities, hosts.
std::string KeystoreJson(const Keystore& keystore);

}  // namespace palpate::command
