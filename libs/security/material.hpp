// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/core/severity.hpp"

namespace palpate::security {

/// The files with which one identity takes part in a secured domain, in the layout of ROS 2's
/// keystores: KEYSTORE/enclaves/NAME.
struct Material {
  std::string name;  ///< of the identity: "capture"
  std::filesystem::path folder;
  std::filesystem::path identity_authority;
  std::filesystem::path certificate;
  std::filesystem::path private_key;
  std::filesystem::path revocation_list;  ///< empty where there is none
  std::filesystem::path permissions_authority;
  std::filesystem::path governance;
  std::filesystem::path permissions;
};

/// What is wrong with a file, and what to do. A warning does not stop a start.
struct Finding {
  Severity severity = Severity::kError;
  std::filesystem::path file;
  std::string problem;
  std::string remedy;

  /// "FILE: PROBLEM: REMEDY"
  std::string ToString() const;
};

/// Warnings begin so long before a certificate ends.
inline constexpr std::int64_t kWarnBeforeEnd_s = std::int64_t{30} * 24 * 3600;

/// Where the files of `name` are; whether they are there is for CheckMaterial().
Material MaterialOf(const std::filesystem::path& keystore, const std::string& name);

/// Everything that is wrong at the time `now_s` (since 1970): missing and unreadable files, a
/// private key that others can read, dates, chain, revocation, signatures, a key or permissions of
/// another identity, one authority for both. Empty: a participant can start.
std::vector<Finding> CheckMaterial(const Material& material, std::int64_t now_s);

/// Those files, checked. Throws InputError with the first error.
Material LoadMaterial(const std::filesystem::path& keystore, const std::string& name,
                      std::int64_t now_s);

/// The text between <tag> and </tag> in `xml`, "" where the tag is not there.
std::string TagText(const std::string& xml, const std::string& tag);

}  // namespace palpate::security
