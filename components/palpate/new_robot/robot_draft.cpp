// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_draft.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "components/palpate/new_robot/marker_guess.hpp"
#include "components/palpate/new_robot/points_text.hpp"
#include "components/palpate/new_robot/silicones.hpp"
#include "components/palpate/new_robot/unit_guess.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr double kGravity_m_s2 = 9.81;
const std::array<std::string, 6> kDirections = {"x", "y", "z", "minus_x", "minus_y", "minus_z"};

Eigen::Vector3d DirectionOf(const std::string& word) {
  const auto found = std::find(kDirections.begin(), kDirections.end(), word);
  if (found == kDirections.end()) {
    throw InputError("'" + Excerpt(word) + "' is no direction: x, y, z, minus_x, minus_y, minus_z");
  }
  const auto index = found - kDirections.begin();
  return (index < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(index % 3);
}

class Drafter {
 public:
  Drafter(const SourceMesh& source, const KnownOfRobot& known, Questions* questions)
      : source_(source), known_(known), questions_(*questions) {}

  RobotDraft Draft() {
    Name();
    Unit();
    Up();
    ParseGivenCables();
    Fixed();
    Material();
    Cables();
    Markers();
    Regions();
    return std::move(draft_);
  }

 private:
  /// Says the guess, and takes what the user types instead of it.
  void Settle(const Decision& guess, const std::string& question, const std::string& standard,
              const std::function<void(const std::string&)>& take) {
    if (guess.trust == Trust::kGiven || !questions_.AsksSomebody()) return;
    fmt::print("{}: {} ({}: {})\n", guess.what, guess.value, ToString(guess.trust), guess.why);
    questions_.AskUntil("  " + question, standard, [&](const std::string& answer) {
      if (answer != standard) take(answer);
    });
  }

  void Name() {
    std::string name = known_.name.empty() ? source_.file.stem().string() : known_.name;
    for (char& letter : name) {
      if (std::string(",;\"' ").find(letter) != std::string::npos) letter = '_';
    }
    draft_.description.name = name;
  }

  void Unit() {
    Decision unit = DecideUnit(source_, known_.unit);
    Settle(unit, "unit of the mesh file: m, cm or mm", unit.value, [&](const std::string& answer) {
      MetresPerUnit(answer);
      unit = DecideUnit(source_, answer);
    });
    metres_per_unit_ = MetresPerUnit(unit.value);
    draft_.description.mesh.file = source_.file;
    draft_.description.mesh.metres_per_unit = metres_per_unit_;
    draft_.decisions.push_back(unit);
    fem::TetMesh mesh = source_.mesh;
    mesh.nodes_m *= metres_per_unit_;
    draft_.shape = MeasureShape(mesh);
    draft_.channels = FindChannels(draft_.shape);
  }

  void Up() {
    Decision up{.what = "up",
                .value = "z",
                .why = "no mesh says it, and most drawings have z up",
                .option = "--up"};
    const auto given = [&](const std::string& word) {
      DirectionOf(word);
      up.value = word;
      up.trust = Trust::kGiven;
      up.why = "as you said";
    };
    if (!known_.up.empty()) given(known_.up);
    Settle(up, "direction that points up: x, y, z, minus_x, minus_y, minus_z", up.value, given);
    up_ = DirectionOf(up.value);
    draft_.description.gravity_m_s2 = -kGravity_m_s2 * up_;
    draft_.decisions.push_back(up);
  }

  void ParseGivenCables() {
    for (const std::string& text : known_.cables) AddCable(text);
  }

  /// Throws, and adds nothing, where it cannot be.
  void AddCable(const std::string& text) {
    CableRoute route = ParseCable(text, source_, draft_.shape, metres_per_unit_);
    for (const CableRoute& other : draft_.cables) {
      if (other.name == route.name) {
        throw InputError("--cable " + Excerpt(text) + ": cable '" + route.name +
                         "' is there already");
      }
    }
    RefuseFarPoints(draft_.shape, route, metres_per_unit_);
    AddEyelets(draft_.shape, &route);
    draft_.cables.push_back(std::move(route));
  }

  void Fixed() {
    if (!known_.fixed.empty()) {
      draft_.fixed = FixedByWords(known_.fixed, source_, draft_.shape, metres_per_unit_);
    } else {
      std::vector<Eigen::Vector3d> pulls_m;
      for (const CableRoute& route : draft_.cables) pulls_m.emplace_back(route.path_m.col(0));
      draft_.fixed = GuessFixed(source_, draft_.shape, pulls_m, up_);
    }
    Settle(draft_.fixed.decision, "what is fixed: Enter, or " + FixedChoices(source_), "that",
           [&](const std::string& answer) {
             draft_.fixed = FixedByWords({answer}, source_, draft_.shape, metres_per_unit_);
           });
    draft_.description.fixed = draft_.fixed.boxes;
    draft_.description.fixed_where.resize(draft_.fixed.boxes.size());
    draft_.decisions.push_back(draft_.fixed.decision);
  }

  void Material() {
    Decision material{
        .what = "material", .value = "dragon_skin_10", .why = {}, .option = "--material"};
    const auto describe = [&] {
      const Silicone& silicone = FindSilicone(material.value);
      material.why = fmt::format("{} by its data sheet; silicones of soft robots have {}",
                                 silicone.title, ModulusRangeText());
    };
    const auto given = [&](const std::string& name) {
      FindSilicone(name);
      material.value = name;
      material.trust = Trust::kGiven;
      describe();
    };
    describe();
    if (!known_.material.empty()) given(known_.material);
    Settle(material, "material: " + Listed(SiliconeNames()), material.value, given);
    const Silicone& silicone = FindSilicone(material.value);
    fem::Material& elastic = draft_.description.material;
    elastic.model = fem::MaterialModel::kStableNeoHookean;
    // Three digits: the data sheet has two.
    elastic.youngs_modulus_Pa = std::round(1e-3 * silicone.YoungsModulus_Pa()) * 1e3;
    elastic.poissons_ratio = 0.49;
    elastic.volumetric = fem::Volumetric::kMeanDilatation;
    draft_.description.mass.density_kg_m3 = silicone.density_kg_m3;
    draft_.decisions.push_back(material);
  }

  void Cables() {
    if (draft_.cables.empty()) {
      draft_.cables = GuessCables(source_, draft_.shape, draft_.channels, draft_.fixed.centre_m);
      for (CableRoute& route : draft_.cables) {
        RefuseFarPoints(draft_.shape, route, metres_per_unit_);
        AddEyelets(draft_.shape, &route);
      }
    }
    AskForCables();
    for (const CableRoute& route : draft_.cables) Describe(route);
    if (draft_.cables.empty()) {
      draft_.decisions.push_back(
          {.what = "cables",
           .value = "none",
           .why = "the mesh names none and has no straight channels; give each one with "
                  "--cable NAME=x,y,z;x,y,z, pull point first",
           .option = "--cable"});
    }
  }

  void AskForCables() {
    if (!questions_.AsksSomebody() || !known_.cables.empty()) return;
    for (const CableRoute& route : draft_.cables) {
      fmt::print("cable {}: {} ({}: {})\n", route.name, PathText(route), ToString(route.trust),
                 route.why);
    }
    bool more = true;
    while (more && questions_.AsksSomebody()) {
      questions_.AskUntil(
          "  another cable, NAME=x,y,z;x,y,z;... in the unit of the mesh file, pull point first; "
          "Enter: no more",
          "", [&](const std::string& answer) {
            more = !answer.empty();
            if (more) AddCable(answer);
          });
    }
  }

  static std::string PathText(const CableRoute& route) {
    return fmt::format("{} to {}, {} eyelets", PointText_mm(route.path_m.col(0)),
                       PointText_mm(route.path_m.col(route.path_m.cols() - 1)),
                       route.path_m.cols() - 1);
  }

  void Describe(const CableRoute& route) {
    draft_.decisions.push_back({.what = "cable " + route.name,
                                .value = PathText(route),
                                .trust = route.trust,
                                .why = route.why,
                                .option = "--cable"});
    draft_.description.cables.push_back({.name = route.name,
                                         .path_m = route.path_m,
                                         .guide_radius_m = route.guide_radius_m,
                                         .where = {}});
  }

  void Markers() {
    auto& markers = draft_.description.markers;
    markers = NamedMarkers(source_, draft_.shape);
    Decision decision{.what = "markers", .value = {}, .why = {}, .option = "--markers"};
    if (!markers.empty()) {
      decision.trust = Trust::kNamed;
      decision.why = "points of the mesh file are named so";
    } else {
      markers = SpreadMarkers(draft_.shape, draft_.fixed, draft_.channels, known_.markers);
      decision.why = markers.empty()
                         ? "none were asked for"
                         : "places spread over the surface: glue markers there, or write yours";
    }
    decision.value = std::to_string(markers.size());
    draft_.decisions.push_back(decision);
  }

  void Regions() {
    for (const fem::CellGroup& group : source_.mesh.groups) {
      if (static_cast<int>(group.cells.size()) < source_.mesh.CellCount()) {
        draft_.regions.push_back(group.name);
      }
    }
  }

  const SourceMesh& source_;
  const KnownOfRobot& known_;
  Questions& questions_;
  RobotDraft draft_;
  double metres_per_unit_ = 1.0;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
};

}  // namespace

const Decision& RobotDraft::Of(const std::string& what) const {
  const auto found = std::find_if(decisions.begin(), decisions.end(),
                                  [&](const Decision& decision) { return decision.what == what; });
  PALPATE_CHECK(found != decisions.end(), what);
  return *found;
}

RobotDraft DraftRobot(const SourceMesh& source, const KnownOfRobot& known, Questions* questions) {
  return Drafter(source, known, questions).Draft();
}

}  // namespace palpate::command
