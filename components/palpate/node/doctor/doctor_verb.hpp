// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/doctor/check.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

struct DoctorOptions {
  std::string system;           ///< a system file, or the name of one; empty: none
  std::string host;             ///< of the system file; empty: this one
  int domain_id = 0;            ///< -1: as the environment says
  std::string domain_trouble;   ///< why the environment names no domain
  std::filesystem::path robot;  ///< empty: not checked
  std::filesystem::path calibration;
  std::filesystem::path security;
  std::vector<std::string> cameras;  ///< addresses outside the local network
  bool json = false;
};

/// Judges this machine, in at most ten seconds. Throws InputError for a system file that cannot be
/// read.
std::vector<Check> Diagnose(const DoctorOptions& options);

/// `palpate doctor`: prints the checks; exit code 1 where one fails.
app::Verb DoctorVerb();

}  // namespace palpate::command
