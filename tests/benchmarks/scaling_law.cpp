// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/scaling_law.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "libs/linalg/qr.hpp"
#include "tests/benchmarks/contender.hpp"

namespace palpate::benchmarks {

namespace {

struct Quantity {
  std::string name;
  std::string benchmark;  ///< after the mesh's name
  std::string counter;    ///< empty: the time
};

std::vector<Quantity> Quantities() {
  const std::string factorize = "/factorize/multifrontal";
  std::vector<Quantity> quantities = {{"update_51_points_ms", "/update_51_points/multifrontal", ""},
                                      {"assemble_ms", "/assemble_stable_neo_hookean/1_thread", ""},
                                      {"solve_8_columns_ms", "/solve_8_columns/multifrontal", ""},
                                      {"factor_flops", factorize, kFlops},
                                      {"factor_nonzeros", factorize, kNonzeros},
                                      {"memory_MiB", factorize, kMemory}};
  for (const Contender& contender : AllContenders()) {
    quantities.push_back(
        {"factorize_" + contender.name + "_ms", "/factorize/" + contender.name, ""});
  }
  return quantities;
}

double QuantityValue(const Quantity& quantity, const Result& result) {
  return quantity.counter.empty() ? result.ComparedMs() : result.Counter(quantity.counter);
}

ScalingLaw Fit(const Quantity& quantity, const std::vector<double>& rows,
               const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd design(count, 2);
  design.col(0).setOnes();
  design.col(1) = Eigen::Map<const Eigen::VectorXd>(rows.data(), count).array().log();
  const Eigen::VectorXd logarithms =
      Eigen::Map<const Eigen::VectorXd>(values.data(), count).array().log();
  const Eigen::Vector2d fit = linalg::LeastSquares(design, logarithms);
  return {.quantity = quantity.name, .factor = std::exp(fit[0]), .exponent = fit[1], .rows = rows};
}

}  // namespace

std::vector<ScalingLaw> FitScalingLaws(const Results& results,
                                       const std::vector<std::string>& family) {
  std::vector<ScalingLaw> laws;
  for (const Quantity& quantity : Quantities()) {
    std::vector<double> rows;
    std::vector<double> values;
    for (const std::string& mesh : family) {
      const Result* result = results.Find(mesh + quantity.benchmark);
      if (result == nullptr) continue;
      rows.push_back(result->Counter(kRows));
      values.push_back(QuantityValue(quantity, *result));
    }
    if (rows.size() >= 2) laws.push_back(Fit(quantity, rows, values));
  }
  return laws;
}

void Print(std::ostream& out, const std::vector<ScalingLaw>& laws,
           const std::vector<std::string>& family) {
  if (laws.empty()) return;
  out << "\nScaling laws, least squares of the logarithms over the linear meshes of one body:";
  for (const std::string& mesh : family) out << ' ' << mesh;
  out << "\n(tet10 is left out: its rows hold more entries each)\n\n";
  for (const ScalingLaw& law : laws) {
    const auto [fewest, most] = std::minmax_element(law.rows.begin(), law.rows.end());
    out << std::left << std::setw(40) << law.quantity << " = " << std::scientific
        << std::setprecision(2) << law.factor << " rows^" << std::fixed << law.exponent << "   "
        << law.rows.size() << " meshes of " << std::setprecision(0) << *fewest << " to " << *most
        << " rows\n"
        << std::defaultfloat;
  }
}

std::vector<benchmark::BenchmarkReporter::Run> ToRuns(const std::vector<ScalingLaw>& laws) {
  std::vector<benchmark::BenchmarkReporter::Run> runs;
  for (const ScalingLaw& law : laws) {
    benchmark::BenchmarkReporter::Run run;
    run.run_name.function_name = "scaling_law/" + law.quantity;
    run.family_index = run.per_family_instance_index = 0;
    run.repetitions = 1;
    run.repetition_index = 0;
    run.statistics = nullptr;
    const auto [fewest, most] = std::minmax_element(law.rows.begin(), law.rows.end());
    run.counters["exponent"] = law.exponent;
    run.counters["factor"] = law.factor;
    run.counters["meshes"] = static_cast<double>(law.rows.size());
    run.counters["fewest_rows"] = *fewest;
    run.counters["most_rows"] = *most;
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace palpate::benchmarks
