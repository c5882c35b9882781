// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "libs/security/permissions.hpp"

namespace palpate::command {

/// Somebody who takes part in a secured domain.
struct Identity {
  std::string name;  ///< "capture", "left_capture": letters, digits, _
  std::string role;  ///< component or command whose rights it has: "capture"
  std::string host;  ///< where its files belong; empty: not said
  std::string node_namespace = "/";
  std::vector<std::string> remap;
};

/// What a keystore knows of an identity.
struct EnrolledIdentity {
  Identity identity;
  std::string serial_hex;  ///< of its certificate
};

/// What a host must have, and what it was seen to have.
struct HostState {
  int needed = 0;  ///< version of the last change of its files
  int seen = 0;    ///< version of the last good `palpate security check --host`
};

/// The register of a keystore, KEYSTORE/manifest.json.
struct Manifest {
  int version = 0;  ///< rises with each change
  std::map<std::string, EnrolledIdentity> identities;
  std::map<std::string, std::string> revoked;  ///< serial number -> name
  std::map<std::string, HostState> hosts;
};

/// Throws InputError where the file is missing or none.
Manifest ReadManifest(const std::filesystem::path& keystore);

/// Throws RunError where it cannot be written.
void WriteManifest(const std::filesystem::path& keystore, const Manifest& manifest);

}  // namespace palpate::command
