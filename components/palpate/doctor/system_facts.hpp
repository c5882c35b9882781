// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// What the processes of one host need, for `palpate doctor`.
struct SystemFacts {
  bool has_genicam_camera = false;    ///< palpate-capture runs here, with a real one
  std::filesystem::path robot;        ///< of palpate-force-estimation here; empty: none
  std::filesystem::path calibration;  ///< given to it; empty: none
};

SystemFacts FactsOf(const HostPlan& host);

}  // namespace palpate::command
