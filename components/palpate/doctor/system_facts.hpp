// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::command {

/// What a system file says of the things that `palpate doctor` checks. `palpate launch` reads such
/// files strictly; here other keys are passed over.
struct SystemFacts {
  std::optional<int> domain_id;
  std::string transport;              ///< "lan": config/cyclonedds/lan.xml; empty: not told
  std::string network_interface;      ///< of this host; empty: not told
  std::filesystem::path security;     ///< empty: none
  std::vector<std::string> peers;     ///< addresses of the other hosts
  bool has_genicam_camera = false;    ///< palpate-capture runs here, with a real one
  std::filesystem::path robot;        ///< of palpate-force-estimation here; empty: none
  std::filesystem::path calibration;  ///< given to it; empty: none
};

/// `host`: which of the hosts this one is; empty: the only one, else the one of that address or
/// name. Throws InputError where the file has hosts, and none of them is this one.
SystemFacts ReadSystemFacts(const ConfigNode& root, const std::string& host,
                            const std::vector<std::string>& own_names);

}  // namespace palpate::command
