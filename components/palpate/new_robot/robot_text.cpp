// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_text.hpp"

#include <fmt/core.h>

#include <cmath>

#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

/// Coordinates to a ten-millionth of the decade of the diagonal.
class Coordinates {
 public:
  explicit Coordinates(double diagonal_m)
      : per_m_(std::pow(10.0, 7.0 - std::floor(std::log10(diagonal_m)))) {}

  std::string Text(double value_m) const {
    const double rounded = std::round(value_m * per_m_) / per_m_;
    return FormatNumber(rounded == 0.0 ? 0.0 : rounded);
  }
  std::string Text(const Eigen::Vector3d& point_m) const {
    return "[" + Text(point_m.x()) + ", " + Text(point_m.y()) + ", " + Text(point_m.z()) + "]";
  }

 private:
  double per_m_;
};

std::string Because(const Decision& decision) {
  return ToString(decision.trust) + ": " + decision.why + ".";
}

std::string HeadText(const RobotDraft& draft) {
  return CommentText("Robot file of " + draft.description.name +
                     ", begun by palpate new-robot. docs/robot_file.md explains every key.") +
         CommentText(
             "Each comment says how well a value is founded: \"given\", \"named in the "
             "mesh\", \"likely\", or \"guess\". Check the guesses first. Lengths are in "
             "metres, in the frame of the mesh file.");
}

std::string MeshText(const RobotDraft& draft, const std::string& mesh) {
  return "\n" + CommentText("Unit of the mesh file, " + Because(draft.Of("unit"))) +
         "mesh: {file: " + Quoted(mesh) + ", unit: " + draft.Of("unit").value + "}\n" +
         CommentText("10-node elements, which do not lock.") + "element: tet10\n";
}

std::string MaterialText(const RobotDraft& draft) {
  const fem::Material& material = draft.description.material;
  return "\n" +
         CommentText("Elasticity, " + Because(draft.Of("material")) +
                     " palpate calibrate estimates youngs_modulus_Pa where the data determine it. "
                     "Silicone hardly changes its volume: Poisson's ratio is 0.49.") +
         "material:\n  model: stable_neo_hookean\n  youngs_modulus_Pa: " +
         FormatNumber(material.youngs_modulus_Pa) +
         "\n  poissons_ratio: " + FormatNumber(material.poissons_ratio) + "\n" +
         CommentText("Of the data sheet. Better: weigh the body, and write total_kg instead.") +
         "mass: {density_kg_m3: " + FormatNumber(*draft.description.mass.density_kg_m3) + "}\n";
}

std::string FixedText(const RobotDraft& draft, const Coordinates& coordinates) {
  const Eigen::Vector3d& g = draft.description.gravity_m_s2;
  std::string text =
      "\n" +
      CommentText("Gravity in the frame of the mesh; up is " + draft.Of("up").value + ", " +
                  Because(draft.Of("up"))) +
      fmt::format("gravity_m_s2: [{:g}, {:g}, {:g}]\n", g.x() + 0.0, g.y() + 0.0, g.z() + 0.0) +
      "\n" +
      CommentText("What does not move: all nodes in these boxes. It is the " +
                  draft.Of("fixed").value + "; " + Because(draft.Of("fixed"))) +
      "fixed:\n";
  for (const robot::Box& box : draft.description.fixed) {
    text += "  - {box_m: [" + coordinates.Text(box.lower_m) + ", " + coordinates.Text(box.upper_m) +
            "]}\n";
  }
  return text;
}

std::string CableText(const CableRoute& route, const Coordinates& coordinates) {
  std::string text =
      CommentText(Because({.what = {}, .value = {}, .trust = route.trust, .why = route.why}), 2) +
      "  - name: " + Quoted(route.name) + "\n    path_m:\n";
  for (Eigen::Index k = 0; k < route.path_m.cols(); ++k) {
    text += "      - " + coordinates.Text(route.path_m.col(k)) + "\n";
  }
  return text +
         "    guide_radius_m: " + FormatNumber(std::round(1e6 * route.guide_radius_m) / 1e6) +
         "  # over which an eyelet's force is spread\n"
         "    # max_tension_N: 30  # of your actuator\n";
}

std::string CablesText(const RobotDraft& draft, const Coordinates& coordinates) {
  if (draft.cables.empty()) {
    return "\n" + CommentText("No cables: " + draft.Of("cables").why + ". In this file:") +
           "# cables:\n#   - {name: pull, path_m: [[x, y, z], [x, y, z]]}\n";
  }
  std::string text =
      "\n" +
      CommentText(
          "Cables. First point: where the cable is pulled from, fixed to the ground. "
          "Others: eyelets on the body. The last one holds the cable.") +
      "cables:\n";
  for (const CableRoute& route : draft.cables) text += CableText(route, coordinates);
  return text;
}

std::string MarkersText(const RobotDraft& draft, const Coordinates& coordinates) {
  const auto& markers = draft.description.markers;
  std::string text = "\n" + CommentText("Markers of motion capture, or centres of fiducials, " +
                                        Because(draft.Of("markers")));
  if (markers.empty()) return text + "# markers:\n#   - {name: tip, position_m: [x, y, z]}\n";
  text += "markers:\n";
  for (const robot::MarkerSettings& marker : markers) {
    text += "  - {name: " + Quoted(marker.name) +
            ", position_m: " + coordinates.Text(marker.position_m) + "}\n";
  }
  return text;
}

std::string RegionsText(const RobotDraft& draft) {
  if (draft.regions.empty()) return "";
  std::string text =
      "\n" +
      CommentText(
          "Parts that the mesh file names. With these lines each has a modulus of its "
          "own, which palpate calibrate estimates.") +
      "# regions:\n";
  for (const std::string& group : draft.regions) {
    text += "#   - {name: " + Quoted(group) + ", mesh_group: " + Quoted(group) +
            ", youngs_modulus_Pa: " + FormatNumber(draft.description.material.youngs_modulus_Pa) +
            "}\n";
  }
  return text;
}

}  // namespace

std::string CommentText(const std::string& text, int indent) {
  constexpr std::size_t kColumns = 100;
  const std::string begin = std::string(static_cast<std::size_t>(indent), ' ') + "#";
  std::string lines, line = begin, word;
  const auto add_word = [&] {
    if (word.empty()) return;
    if (line.size() + 1 + word.size() > kColumns && line != begin) {
      lines += line + "\n";
      line = begin;
    }
    line += " " + word;
    word.clear();
  };
  for (const char letter : text) {
    if (letter == ' ' || letter == '\n') {
      add_word();
    } else {
      word += letter;
    }
  }
  add_word();
  return lines + line + "\n";
}

std::string FormatNewRobot(const RobotDraft& draft, const std::string& mesh) {
  const Coordinates coordinates(draft.shape.diagonal_m);
  return HeadText(draft) + "name: " + Quoted(draft.description.name) + "\n" +
         MeshText(draft, mesh) + MaterialText(draft) + FixedText(draft, coordinates) +
         CablesText(draft, coordinates) + MarkersText(draft, coordinates) + RegionsText(draft) +
         "\n" + CommentText("Points of the surface where contacts are searched, spread evenly.") +
         "feature_points: {count: 51}\n";
}

}  // namespace palpate::command
