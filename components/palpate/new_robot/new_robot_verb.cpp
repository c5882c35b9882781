// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/new_robot_verb.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <memory>

#include "components/palpate/new_robot/points_text.hpp"
#include "components/palpate/new_robot/rehearsal.hpp"
#include "components/palpate/new_robot/robot_check.hpp"
#include "components/palpate/new_robot/robot_folder.hpp"
#include "components/palpate/new_robot/robot_picture.hpp"
#include "components/palpate/new_robot/silicones.hpp"
#include "components/palpate/new_robot/unit_guess.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

namespace {

void PrintDecisions(const RobotDraft& draft) {
  for (const Decision& decision : draft.decisions) {
    fmt::print(
        "{}: {}\n    {}: {}{}\n", decision.what, decision.value, ToString(decision.trust),
        decision.why,
        decision.trust == Trust::kGiven ? "" : fmt::format(" ({} changes it)", decision.option));
  }
}

/// Fewer than two elements across the thinnest direction bend too softly or too stiffly.
void PrintMeshAdvice(const RobotDraft& draft) {
  // An element of equal edges is less high than its edge is long.
  constexpr double kLayers = 2.0, kHeightOfEdge = 0.7;
  constexpr int kManyNodes = 20000;
  const BodyShape& shape = draft.shape;
  if (shape.extents_m(2) < kLayers * kHeightOfEdge * shape.element_m) {
    fmt::print(
        "warning: elements of {} in a body of {} across: at least two layers keep the error "
        "of deflections within 0.5 %; mesh it finer\n",
        LengthText(shape.element_m), LengthText(shape.extents_m(2)));
  }
  if (shape.mesh.NodeCount() > kManyNodes) {
    fmt::print(
        "warning: {} nodes with 10-node elements: an estimate takes long for each frame; a "
        "coarser mesh is faster\n",
        shape.mesh.NodeCount());
  }
}

void PrintCheck(const RobotCheck& check) {
  if (check.rest.ok()) {
    fmt::print("under gravity the body sags by {}; an equilibrium takes {:.0f} ms\n",
               LengthText(check.sag_m), 1e3 * check.solve_s);
  }
  for (const PullTrial& trial : check.pulls) {
    if (!trial.status.ok()) continue;
    fmt::print("cable {}: {} pulled in take {:.3g} N and move the tip by {}\n", trial.cable,
               LengthText(trial.pull_m), trial.tension_N, PointText_mm(trial.tip_motion_m));
  }
  for (const std::string& warning : check.warnings) fmt::print("warning: {}\n", warning);
}

void PrintNext(const RobotDraft& draft, const Rehearsal& rehearsal, const RobotFolder& files) {
  const std::string robot = files.robot.string();
  const std::string data = (files.folder / "exp").string();
  const std::string calibration = files.calibration.string();
  const std::string actuation =
      draft.cables.empty() ? "" : " --actuation " + files.actuation.string();
  const std::string pose =
      draft.description.markers.empty() ? " --camera-pose \"" + rehearsal.camera_pose + "\"" : "";
  fmt::print("\nwritten to {}: robot.yaml, robot.png and files to try it\n", files.folder.string());
  fmt::print("Look at {}, and correct robot.yaml where it is wrong. Then:\n",
             files.picture.string());
  fmt::print("  palpate info {}\n", robot);
  fmt::print("  palpate solve {}{} --out {} --png\n", robot, actuation,
             (files.folder / "solved").string());
  fmt::print("Cables by clicks on the body: palpate view {}\n", robot);
  fmt::print("The same robot and a camera without hardware:\n");
  fmt::print("  palpate simulate {} --scenario {} --out {}\n", robot, files.scenario.string(),
             data);
  fmt::print("  palpate calibrate {} --data {}{} --out {}\n", robot, data, pose, calibration);
  fmt::print("  palpate estimate {} --calibration {} --data {} --out {}\n", robot, calibration,
             data, (files.folder / "forces.csv").string());
  fmt::print("  palpate launch {}\n", files.system.string());
}

/// What `palpate info` and `palpate solve` say of the file as it was written.
RobotCheck CheckWritten(const RobotDraft& draft, const RobotFolder& files) {
  robot::RobotModel model(robot::BuildRobotBody(robot::ReadRobotFile(files.robot, app::LoadYaml)));
  for (const std::string& warning : model.body().warnings) fmt::print("warning: {}\n", warning);
  view::SaveScene(files.picture, NewRobotScene(draft, model));
  constexpr double kPatience_s = 60.0;
  return CheckRobot(&model, kPatience_s);
}

}  // namespace

int NewRobot(const NewRobotOptions& options, std::istream* answers) {
  const SourceMesh source = ReadSourceMesh(options.mesh);
  const std::string stem = options.mesh.stem().string();
  const RobotFolder files =
      NameFiles(options.out.empty() ? std::filesystem::path(stem) : options.out, options.mesh);
  RefuseExisting(files, options.mesh, options.force);
  for (const std::string& note : source.notes) fmt::print("note: {}\n", note);
  Questions questions(options.yes ? nullptr : answers);
  const RobotDraft draft = DraftRobot(source, options.known, &questions);
  robot::BuildRobotBody(draft.description);  // refuses before anything is written
  PrintDecisions(draft);
  PrintMeshAdvice(draft);
  const Rehearsal rehearsal =
      MakeRehearsal(draft, files.robot.filename().string(), files.scenario.filename().string(),
                    files.calibration.filename().string());
  WriteRobotFolder(draft, rehearsal, files);
  fmt::print("computing the equilibrium under gravity, and a small pull of each cable ...\n");
  std::fflush(stdout);
  const RobotCheck check = CheckWritten(draft, files);
  PrintCheck(check);
  PrintNext(draft, rehearsal, files);
  return check.ok() ? app::kExitDone : app::kExitFailed;
}

app::Verb NewRobotVerb() {
  return {
      "new-robot", "Make a commented robot file of a mesh, with a picture and files to try it",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<NewRobotOptions>();
        KnownOfRobot& known = options->known;
        arguments.Positional("MESH", &options->mesh,
                             "Mesh of tetrahedra: .msh, .vtu, .vtk, .inp or .mesh");
        arguments.Option("--out FOLDER", &options->out,
                         "Folder of the robot; without it one named after the mesh, in the "
                         "current folder");
        arguments.Option("--name", &known.name, "Name of the robot; without it that of the mesh");
        arguments.Choice("--unit", &known.unit, {"m", "cm", "mm"},
                         "Length unit of the mesh file; without it that of a comment in the file, "
                         "else the one in which the body has the size of a soft robot");
        arguments.Repeated("--fixed REGION", &known.fixed,
                           "What does not move: a group of the mesh, an end of the mesh along an "
                           "axis (x_min, x_max, y_min, ...), or a box \"x,y,z;x,y,z\" in the unit "
                           "of the mesh file; without it a group whose name says so, else a flat "
                           "end of the body");
        arguments.Choice("--up", &known.up, {"x", "y", "z", "minus_x", "minus_y", "minus_z"},
                         "Direction of the mesh's frame that points up; without it z");
        arguments.Option("--material NAME", &known.material,
                         "Silicone rubber of the body, by its data sheet: " +
                             Listed(SiliconeNames()) + "; without it dragon_skin_10");
        arguments.Suggest("--material", SiliconeNames());
        arguments.Repeated(
            "--cable NAME=POINTS", &known.cables,
            "A cable: the point where it is pulled from, eyelets, the point where "
            "it is attached, as \"x,y,z;x,y,z;...\" in the unit of the mesh file or in "
            "another one (\"...;x,y,z m\"), or as names of points of the mesh; two points "
            "in the body get eyelets between them. `palpate view ROBOT.yaml` gives this option by "
            "clicks on the body. Without it points, curves and "
            "straight channels of the mesh");
        arguments.Option("--markers", &known.markers, 0, 200,
                         "Number of places for markers to suggest where the mesh names none");
        arguments.Flag("--yes", &options->yes, "Ask nothing and take each guess");
        arguments.Flag("--force", &options->force, "Replace the files of an earlier run");
        return [options] {
          return NewRobot(*options, isatty(STDIN_FILENO) != 0 ? &std::cin : nullptr);
        };
      }};
}

}  // namespace palpate::command
