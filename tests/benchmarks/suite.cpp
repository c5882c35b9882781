// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/suite.hpp"

#include <memory>
#include <utility>

#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/benchmarks/calibration_bench.hpp"
#include "tests/benchmarks/camera_bench.hpp"
#include "tests/benchmarks/diagnosis_bench.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/measure.hpp"
#include "tests/benchmarks/perception_bench.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/benchmarks/sensing_bench.hpp"
#include "tests/benchmarks/virtual_robot_bench.hpp"
#include "tests/benchmarks/workbench.hpp"

namespace palpate::benchmarks {

namespace {

using SharedBench = std::shared_ptr<Workbench>;

constexpr int kDgemmSize = 768;
constexpr int kFewPoints = 5;

std::string Heading(const NamedRobot& robot) { return robot.name + ": " + robot.note; }

/// On a large mesh a contender that works entry by entry takes tens of seconds a call.
int MaxRepetitions(const NamedRobot& robot, const Contender& contender) {
  return robot.large && contender.by_entries ? 1 : robot.max_repetitions;
}

/// Frames follow one another, so the caches know the model. Threads that have slept take some calls
/// until they start at once, each on a core of its own. A large mesh does not fit into the caches
/// anyway.
WarmUp ChooseWarmUp(const NamedRobot& robot, const Contender& contender) {
  if (robot.large) return {.first = contender.by_entries ? 0 : 1, .each = 0};
  return {.first = 0, .each = contender.by_entries ? 1 : 6};
}

/// A scene that no other benchmark uses.
Benchmark UpdateAlone(const NamedRobot& robot, const std::string& name,
                      const SensingScene::Settings& settings) {
  const auto scene = MakeLazy<SensingScene>(
      [robot, settings] { return std::make_unique<SensingScene>(robot, settings); });
  return {
      .name = robot.name + "/" + name,
      .measure = [scene](benchmark::State& state) { MeasureUpdate(state, scene->Get(), WarmUp()); },
      .max_repetitions = robot.max_repetitions};
}

Block UpdateBlock(const SharedBench& bench) {
  const NamedRobot& robot = bench->robot();
  Block block{.heading = Heading(robot), .benchmarks = {}};
  for (const Contender& contender : ModelContenders()) {
    const WarmUp warm_up = ChooseWarmUp(robot, contender);
    block.benchmarks.push_back({.name = robot.name + "/update_51_points/" + contender.name,
                                .measure =
                                    [bench, contender, warm_up](benchmark::State& state) {
                                      MeasureUpdate(state, bench->Scene(contender), warm_up);
                                    },
                                .threads = contender.settings.threads,
                                .max_repetitions = MaxRepetitions(robot, contender)});
  }
  if (robot.refinements > 0) return block;
  block.benchmarks.push_back(
      UpdateAlone(robot, "update_5_points", {.feature_points = kFewPoints, .solver = {}}));
  using Update = SensingScene::Update;
  block.benchmarks.push_back(UpdateAlone(robot, "update_with_chord_51_points",
                                         {.update = Update::kWithChord, .solver = {}}));
  block.benchmarks.push_back(UpdateAlone(robot, "converged_frame_51_points",
                                         {.update = Update::kConverged, .solver = {}}));
  return block;
}

Block AssemblyBlock(const SharedBench& bench) {
  const NamedRobot& robot = bench->robot();
  const std::string name =
      robot.name + "/assemble_" + std::string(fem::ToString(robot.description.material.model));
  Block block{.heading = Heading(robot), .benchmarks = {}};
  for (const Contender& contender : ModelContenders()) {
    if (contender.settings.solver != ModelContenders().front().settings.solver) continue;
    const int threads = contender.settings.threads;
    const WarmUp warm_up = ChooseWarmUp(robot, contender);
    const auto assembly = MakeLazy<Assembly>(
        [bench, contender] { return std::make_unique<Assembly>(bench->Scene(contender)); });
    block.benchmarks.push_back(
        {.name = name + "/" + std::to_string(threads) + (threads == 1 ? "_thread" : "_threads"),
         .measure =
             [assembly, warm_up](benchmark::State& state) {
               MeasureAssembly(state, assembly->Get(), warm_up);
             },
         .threads = threads,
         .max_repetitions = robot.max_repetitions});
  }
  return block;
}

Block FactorizationBlock(const SharedBench& bench) {
  const NamedRobot& robot = bench->robot();
  Block block{.heading = Heading(robot), .benchmarks = {}};
  for (const Contender& contender : AllContenders()) {
    const WarmUp warm_up = ChooseWarmUp(robot, contender);
    block.benchmarks.push_back({.name = robot.name + "/factorize/" + contender.name,
                                .measure =
                                    [bench, contender, warm_up](benchmark::State& state) {
                                      MeasureFactorization(state, bench->Solver(contender),
                                                           warm_up);
                                    },
                                .threads = contender.settings.threads,
                                .max_repetitions = MaxRepetitions(robot, contender)});
  }
  return block;
}

Block SolutionBlock(const SharedBench& bench, int columns, const std::string& name) {
  const NamedRobot& robot = bench->robot();
  Block block{.heading = Heading(robot), .benchmarks = {}};
  for (const Contender& contender : AllContenders()) {
    const WarmUp warm_up = ChooseWarmUp(robot, contender);
    block.benchmarks.push_back({.name = robot.name + "/" + name + "/" + contender.name,
                                .measure =
                                    [bench, contender, columns, warm_up](benchmark::State& state) {
                                      MeasureSolution(state, bench->Solver(contender), columns,
                                                      warm_up);
                                    },
                                .threads = contender.settings.threads,
                                .max_repetitions = robot.max_repetitions});
  }
  return block;
}

void AddRobot(std::vector<Block>* blocks, const NamedRobot& robot) {
  const auto bench = std::make_shared<Workbench>(robot);
  blocks->push_back(UpdateBlock(bench));
  blocks->push_back(AssemblyBlock(bench));
  blocks->push_back(FactorizationBlock(bench));
  blocks->push_back(SolutionBlock(bench, 1, "solve_1_column"));
  blocks->push_back(SolutionBlock(bench, 8, "solve_8_columns"));
}

void AddAssembly(std::vector<Block>* blocks, NamedRobot robot, fem::MaterialModel model) {
  robot.description.material.model = model;
  blocks->push_back(AssemblyBlock(std::make_shared<Workbench>(robot)));
}

Block ReadingBlock(const robot::MeshSettings& mesh) {
  const auto read = [mesh](benchmark::State& state) {
    for ([[maybe_unused]] auto iteration : state) {
      benchmark::DoNotOptimize(fem::ReadMesh(mesh.file, mesh.metres_per_unit));
    }
  };
  return {.heading = "reading a mesh",
          .benchmarks = {{.name = "read_mesh/" + mesh.file.filename().string(), .measure = read}}};
}

Block MachineBlock() {
  return {.heading = "what one core can do",
          .benchmarks = {
              {.name = "dgemm_" + std::to_string(kDgemmSize),
               .measure = [](benchmark::State& state) { MeasureDgemm(state, kDgemmSize); }}}};
}

}  // namespace

Suite MakeSuite() {
  using fem::ElementType;
  const NamedRobot paper = PaperRobot(ElementType::kTet4);
  const NamedRobot linear = OwnRobot("four_leg", ElementType::kTet4);
  const NamedRobot beam = OwnRobot("beam", ElementType::kTet10);
  Suite suite;
  suite.blocks.push_back(MachineBlock());
  AddRobot(&suite.blocks, paper);
  AddAssembly(&suite.blocks, paper, fem::MaterialModel::kCorotational);
  for (const NamedRobot& robot :
       {PaperRobot(ElementType::kTet10), linear, OwnRobot("four_leg", ElementType::kTet10), beam,
        PaperRobot(ElementType::kTet4, 1), PaperRobot(ElementType::kTet4, 2)}) {
    AddRobot(&suite.blocks, robot);
  }
  suite.blocks.push_back(ReadingBlock(linear.description.mesh));
  suite.blocks.push_back(ReadingBlock(beam.description.mesh));
  if (paper.description.mesh.file != linear.description.mesh.file) {
    suite.blocks.push_back(ReadingBlock(paper.description.mesh));
  }
  suite.blocks.push_back(CameraBlock());
  suite.blocks.push_back(PerceptionBlock());
  suite.blocks.push_back(CalibrationBlock());
  suite.blocks.push_back(VirtualRobotBlock());
  for (Block& block : SensingBlocks()) suite.blocks.push_back(std::move(block));
  for (Block& block : DiagnosisBlocks()) suite.blocks.push_back(std::move(block));
  for (const int refinements : {0, 1, 2}) {
    suite.family.push_back(PaperRobot(ElementType::kTet4, refinements).name);
  }
  return suite;
}

}  // namespace palpate::benchmarks
