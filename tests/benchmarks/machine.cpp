// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/machine.hpp"

#include <cstdlib>
#include <fstream>
#include <thread>

#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/sparse/elimination_order.hpp"

// OpenBLAS, where the BLAS in use is OpenBLAS.
extern "C" char* openblas_get_config() __attribute__((weak));
extern "C" char* openblas_get_corename() __attribute__((weak));

namespace palpate::benchmarks {

namespace {

std::string Processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string Load() {
  std::ifstream file("/proc/loadavg");
  std::string one_minute;
  file >> one_minute;
  return one_minute;
}

std::string Blas() {
  if (openblas_get_config == nullptr || openblas_get_corename == nullptr) return "not OpenBLAS";
  fem::FindEliminationOrder(1, {});  // the first use of the solver chooses the kernels of the BLAS
  const std::string config = openblas_get_config();
  const size_t version_end = config.find(' ', config.find(' ') + 1);
  return config.substr(0, version_end) + ", kernels " + openblas_get_corename() + ", one thread";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> DescribeMachine() {
  return {{"processor", Processor()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"load_one_minute", Load()},
          {"blas", Blas()},
          {"element_kernels", fem::kernels::InstructionSet()},
          {"compiler", "g++ " __VERSION__ ", " PALPATE_BUILD_TYPE}};
}

}  // namespace palpate::benchmarks
