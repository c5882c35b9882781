// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/suite.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/benchmarks/memory.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/benchmarks/sensing_scene.hpp"
#include "tests/benchmarks/stages.hpp"

namespace palpate::benchmarks {

namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;
constexpr int kManyPoints = 51;
constexpr int kFewPoints = 5;

/// Something expensive, made when it is first asked for.
template <typename T>
class Lazy {
 public:
  explicit Lazy(std::function<std::unique_ptr<T>()> make) : make_(std::move(make)) {}
  T& Get() {
    if (!made_) made_ = make_();
    return *made_;
  }

 private:
  std::function<std::unique_ptr<T>()> make_;
  std::unique_ptr<T> made_;
};

using Measured = std::function<void(benchmark::State&)>;

double Smallest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

/// One call for each repetition, so that the median is one over calls.
void Register(std::vector<Row>* rows, const std::string& name, const std::string& reference,
              const Measured& measured) {
  const auto guarded = [measured](benchmark::State& state) {
    try {
      measured(state);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), guarded)
      ->Iterations(1)
      ->ComputeStatistics("min", Smallest)
      ->Unit(benchmark::kMillisecond);
  rows->push_back({name, reference});
}

void MeasureUpdate(benchmark::State& state, SensingScene& scene) {
  scene.TakeFrame();
  for ([[maybe_unused]] auto iteration : state) scene.TakeFrame();
  const fem::SparseSolver& solver = scene.model().linearisation().solver();
  state.counters["memory_MiB"] = static_cast<double>(solver.MemoryBytes()) / kMebibyte;
  state.counters["qp_steps"] = scene.qp_steps();
  state.counters["peak_rss_MiB"] = PeakResidentBytes() / kMebibyte;
}

void RegisterUpdate(std::vector<Row>* rows, const NamedRobot& robot, const std::string& name,
                    const std::string& reference, int points, SensingScene::Update update) {
  const auto scene =
      std::make_shared<Lazy<SensingScene>>([description = robot.description, points, update] {
        return std::make_unique<SensingScene>(description, points, update);
      });
  Register(rows, robot.name + "/" + name, reference,
           [scene](benchmark::State& state) { MeasureUpdate(state, scene->Get()); });
}

void RegisterAssembly(std::vector<Row>* rows, const NamedRobot& robot, fem::MaterialModel model,
                      const std::string& reference) {
  robot::RobotDescription description = robot.description;
  description.material.model = model;
  const auto stages = std::make_shared<Lazy<Stages>>(
      [description] { return std::make_unique<Stages>(description); });
  Register(rows, robot.name + "/assemble_" + std::string(fem::ToString(model)), reference,
           [stages](benchmark::State& state) {
             stages->Get().Assemble();
             for ([[maybe_unused]] auto iteration : state) stages->Get().Assemble();
           });
}

void RegisterSolver(std::vector<Row>* rows, const NamedRobot& robot, const std::string& reference) {
  const auto stages = std::make_shared<Lazy<Stages>>(
      [description = robot.description] { return std::make_unique<Stages>(description); });
  Register(rows, robot.name + "/factorize", reference, [stages](benchmark::State& state) {
    Stages& ready = stages->Get();
    ready.Factorize();
    for ([[maybe_unused]] auto iteration : state) ready.Factorize();
    state.counters["memory_MiB"] = static_cast<double>(ready.solver().MemoryBytes()) / kMebibyte;
    state.counters["rows"] = ready.Size();
    state.counters["factor_nonzeros"] = static_cast<double>(ready.solver().FactorNonzeros());
    state.counters["factor_flops"] = ready.solver().FactorFlops();
  });
  Register(rows, robot.name + "/solve_8_columns", reference, [stages](benchmark::State& state) {
    Stages& ready = stages->Get();
    ready.Factorize();
    ready.ResetColumns();
    ready.Solve();
    ready.ResetColumns();
    for ([[maybe_unused]] auto iteration : state) ready.Solve();
  });
}

void RegisterRobot(std::vector<Row>* rows, const NamedRobot& robot,
                   const std::vector<fem::MaterialModel>& models) {
  using Update = SensingScene::Update;
  const std::string whole = robot.name + "/update_51_points";
  const std::string compared = rows->empty() ? whole : rows->front().name;
  RegisterUpdate(rows, robot, "update_51_points", compared, kManyPoints, Update::kOneStep);
  RegisterUpdate(rows, robot, "update_5_points", whole, kFewPoints, Update::kOneStep);
  RegisterUpdate(rows, robot, "converged_frame_51_points", whole, kManyPoints, Update::kConverged);
  for (const fem::MaterialModel model : models) RegisterAssembly(rows, robot, model, whole);
  RegisterSolver(rows, robot, whole);
}

void RegisterReading(std::vector<Row>* rows, const NamedRobot& robot,
                     const std::string& reference) {
  const robot::MeshSettings mesh = robot.description.mesh;
  const std::string name = "read_mesh/" + mesh.file.filename().string();
  Register(rows, name, reference, [mesh](benchmark::State& state) {
    for ([[maybe_unused]] auto iteration : state) {
      benchmark::DoNotOptimize(fem::ReadMesh(mesh.file, mesh.metres_per_unit));
    }
  });
}

}  // namespace

std::vector<Row> RegisterAll() {
  using fem::MaterialModel;
  const NamedRobot paper = PaperRobot();
  const NamedRobot linear = OwnRobot("four_leg", fem::ElementType::kTet4);
  const NamedRobot quadratic = OwnRobot("four_leg", fem::ElementType::kTet10);
  const NamedRobot beam = OwnRobot("beam", fem::ElementType::kTet10);
  std::vector<Row> rows;
  RegisterRobot(&rows, paper, {MaterialModel::kCorotational, MaterialModel::kStableNeoHookean});
  for (const NamedRobot& robot : {linear, quadratic, beam}) {
    RegisterRobot(&rows, robot, {MaterialModel::kStableNeoHookean});
  }
  const std::string first_update = rows.front().name;
  RegisterReading(&rows, paper, first_update);
  if (paper.description.mesh.file != linear.description.mesh.file) {
    RegisterReading(&rows, linear, first_update);
  }
  RegisterReading(&rows, beam, first_update);
  return rows;
}

}  // namespace palpate::benchmarks
