// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/doctor/check.hpp"
#include "components/palpate/security/keystore_check.hpp"
#include "libs/core/instruction_set.hpp"
#include "libs/core/status.hpp"

/// What `palpate doctor` checks of the computer itself, from facts that tests can make up.
namespace palpate::command {

struct ProcessorFacts {
  InstructionSet best = InstructionSet::kPortable;
  int threads = 1;
  std::string blas_core;     ///< OPENBLAS_CORETYPE of the environment; empty: OpenBLAS chooses
  std::string governor;      ///< of the first core; empty: unknown
  std::string thread_limit;  ///< OMP_NUM_THREADS of the environment; empty: none
};

/// Instruction set of the solver's kernels, threads, clock governor.
Check CheckProcessor(const ProcessorFacts& facts);

struct DiskFacts {
  std::filesystem::path folder;
  std::optional<std::uint64_t> free_B;  ///< nullopt: cannot be read
};

/// Room for recordings in the current folder: raw images need some 60 MB/s.
Check CheckDisk(const DiskFacts& facts);

struct SecurityFacts {
  bool is_on = false;            ///< the processes are to be secured
  std::filesystem::path folder;  ///< a keystore, or the files of a host; empty: none given
  std::string trouble;           ///< why it cannot be read; empty: `state` says what is there
  KeystoreState state;
  std::int64_t now_s = 0;  ///< since 1970
};

/// The files of DDS Security, as `palpate security check` judges them.
Check CheckSecurity(const SecurityFacts& facts);

struct CameraFacts {
  std::string model;
  std::string address;
  int mtu_B = 0;  ///< of this host's interface to it; 0: unknown, or not a network
  std::string interface;
  std::string trouble;
};

/// Cameras that answer, and the MTU on the way to each.
Check CheckCameras(const std::vector<CameraFacts>& cameras, bool needed);

/// `fit`: what comparing the robot file with the calibration file gave.
Check CheckRobotFiles(const std::string& robot, const std::string& calibration, const Status& fit);

}  // namespace palpate::command
