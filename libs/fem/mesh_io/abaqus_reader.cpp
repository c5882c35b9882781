// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

namespace {

std::string InUpperCase(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return upper;
}

std::string_view WithoutBlanks(std::string_view text) {
  const size_t first = text.find_first_not_of(kWhiteSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhiteSpace) - first + 1);
}

/// "*ELEMENT, TYPE=C3D4, ELSET=body": name in upper case without the asterisk, and parameters whose
/// names are in upper case.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;

  std::string Get(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? "" : found->second;
  }
};

/// Reads the nodes, tetrahedra, element sets and node sets of an input file of Abaqus or CalculiX;
/// all other keywords are passed over. Element sets are groups.
class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, MeshBuilder* builder) : rest_(bytes), builder_(builder) {}

  void Read() {
    while (NextLine()) {
      if (line_.starts_with('*')) {
        BeginBlock();
      } else {
        (this->*take_)();
      }
    }
    FinishElement();
    if (keywords_ == 0) Fail("is no Abaqus input file: it has no keyword (*NODE, *ELEMENT)");
    FinishSets();
    FinishNodeSets();
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(SourceLocation{builder_->file(), line_number_, 0}, message);
  }

  /// Comments and blank lines are passed over.
  bool NextLine() {
    while (!rest_.empty()) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = WithoutBlanks(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_number_;
      if (!line_.empty() && !line_.starts_with("**")) return true;
    }
    return false;
  }

  static std::vector<std::string_view> Split(std::string_view line) {
    std::vector<std::string_view> parts;
    for (size_t begin = 0; begin <= line.size();) {
      const size_t end = std::min(line.find(',', begin), line.size());
      parts.push_back(WithoutBlanks(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    // A comma at the end continues the line.
    if (parts.back().empty()) parts.pop_back();
    return parts;
  }

  /// A comma at the end of the line continues it.
  Keyword ParseKeyword() {
    Keyword keyword;
    std::string whole(line_);
    while (whole.ends_with(',') && NextLine()) whole += line_;
    for (const std::string_view part : Split(whole)) {
      const size_t equals = part.find('=');
      const std::string name = InUpperCase(WithoutBlanks(part.substr(0, equals)));
      if (keyword.name.empty()) {
        keyword.name = name.substr(1);
      } else {
        std::string_view value =
            equals == std::string_view::npos ? "" : WithoutBlanks(part.substr(equals + 1));
        if (value.size() > 1 && value.starts_with('"') && value.ends_with('"')) {
          value = value.substr(1, value.size() - 2);
        }
        keyword.parameters[name] = value;
      }
    }
    return keyword;
  }

  void BeginBlock() {
    FinishElement();
    ++keywords_;
    const Keyword keyword = ParseKeyword();
    take_ = &AbaqusReader::PassOver;
    RefuseOtherFile(keyword);
    if (keyword.name == "NODE") {
      BeginNodes(keyword);
    } else if (keyword.name == "ELEMENT") {
      BeginElements(keyword);
    } else if (keyword.name == "ELSET") {
      BeginSet(keyword);
    } else if (keyword.name == "NSET") {
      BeginNodeSet(keyword);
    } else if (keyword.name == "PART" && ++parts_ > 1) {
      Fail("a second *PART: save the body as one part");
    } else if (keyword.name == "INSTANCE") {
      if (++instances_ > 1) Fail("a second *INSTANCE: save the body as one part");
      in_assembly_ = false;
      take_ = &AbaqusReader::RefuseMove;
    } else if (keyword.name == "ASSEMBLY" || keyword.name == "END INSTANCE") {
      in_assembly_ = true;
    } else if (keyword.name == "END ASSEMBLY") {
      in_assembly_ = false;
    } else if (keyword.name == "NGEN" || keyword.name == "NFILL" || keyword.name == "NCOPY" ||
               keyword.name == "ELGEN" || keyword.name == "ELCOPY" || keyword.name == "SYSTEM") {
      Fail("*" + keyword.name + " is not read: write the nodes and elements themselves");
    }
  }

  void RefuseOtherFile(const Keyword& keyword) const {
    const bool of_mesh =
        keyword.name == "NODE" || keyword.name == "ELEMENT" || keyword.name == "ELSET";
    if (keyword.name != "INCLUDE" && !(of_mesh && keyword.parameters.contains("INPUT"))) return;
    Fail("*" + keyword.name + " names another file, which is not read: put the mesh in one file");
  }

  /// Of an assembly, outside its instance, nodes and elements have numbers of their own: they are
  /// reference points and connectors, and no part of the body.
  void BeginNodes(const Keyword& keyword) {
    if (in_assembly_) return;
    const std::string system = InUpperCase(keyword.Get("SYSTEM"));
    if (!system.empty() && system != "R") {
      Fail("nodes in cylindrical or spherical coordinates (SYSTEM=" + Excerpt(system) +
           ") are not read, only rectangular ones");
    }
    take_ = &AbaqusReader::TakeNode;
  }

  /// A line below *INSTANCE shifts or turns the part.
  void RefuseMove() {
    Fail(
        "the *INSTANCE moves its part: save the mesh in its place, or remove this line and give "
        "translate_m of the robot file");
  }

  void BeginElements(const Keyword& keyword) {
    if (in_assembly_) return;
    const std::string type = InUpperCase(keyword.Get("TYPE"));
    set_ = NameOfSet(keyword.Get("ELSET"));
    if (type.starts_with("C3D10")) {
      type_ = ElementType::kTet10;
    } else if (type.starts_with("C3D4")) {
      type_ = ElementType::kTet4;
    } else if (type.starts_with("C3D") || type.starts_with("SC") || type.empty()) {
      Fail("elements of type '" + Excerpt(type) + "' are not read, only C3D4 and C3D10");
    } else {
      return;  // lines and surfaces
    }
    take_ = &AbaqusReader::TakeElement;
  }

  void PassOver() {}

  int64_t Integer(std::string_view text, const char* what) const {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1) {
      Fail(std::string(what) + ": '" + Excerpt(text) + "' is no number from 1 on");
    }
    return value;
  }

  /// Fortran's exponents are read, too: "1.5D-3".
  static bool ParseReal(std::string_view text, double* value) {
    std::string number(text);
    std::replace_if(
        number.begin(), number.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
    return ParseFinite(number, value);
  }

  void TakeNode() {
    const auto parts = Split(line_);
    if (parts.size() < 4) Fail("a node has a number and three coordinates");
    const int64_t number = Integer(parts[0], "a node");
    std::array<double, 3> x{};
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!ParseReal(parts[axis + 1], &x[axis])) {
        Fail("a coordinate: '" + Excerpt(parts[axis + 1]) + "' is not a finite number");
      }
    }
    if (!node_of_number_.emplace(number, builder_->NodeCount()).second) {
      Fail("node " + std::to_string(number) + " is given twice");
    }
    builder_->AddNode(x[0], x[1], x[2]);
  }

  /// An element may go on over several lines.
  void TakeElement() {
    for (const std::string_view part : Split(line_))
      pending_.push_back(Integer(part, "an element"));
    pending_line_ = line_number_;
    const size_t needed = static_cast<size_t>(type_) + 1;
    if (pending_.size() > needed) {
      Fail("the element has " + std::to_string(pending_.size() - 1) + " nodes instead of " +
           std::to_string(needed - 1));
    }
    if (pending_.size() == needed) AddElement();
  }

  void AddElement() {
    std::array<int64_t, 10> nodes{};
    for (size_t k = 1; k < pending_.size(); ++k) {
      const auto node = node_of_number_.find(pending_[k]);
      if (node == node_of_number_.end()) {
        Fail("an element names node " + std::to_string(pending_[k]) + ", which does not exist");
      }
      nodes[k - 1] = node->second;
    }
    const int tet = builder_->AddTet(type_, std::span(nodes).first(pending_.size() - 1));
    if (!tet_of_number_.emplace(pending_[0], tet).second) {
      Fail("element " + std::to_string(pending_[0]) + " is given twice");
    }
    if (!set_.empty()) tets_of_set_[set_].push_back(tet);
    pending_.clear();
  }

  void FinishElement() {
    if (pending_.empty()) return;
    line_number_ = pending_line_;
    Fail("the element has " + std::to_string(pending_.size() - 1) + " nodes instead of " +
         std::to_string(static_cast<size_t>(type_)));
  }

  void BeginSet(const Keyword& keyword) {
    if (in_assembly_ && !keyword.parameters.contains("INSTANCE")) return;
    listed_set_ = &NameOfSet(keyword.Get("ELSET"));
    generate_ = keyword.parameters.contains("GENERATE");
    take_ = &AbaqusReader::TakeSet;
  }

  void BeginNodeSet(const Keyword& keyword) {
    const std::string name = keyword.Get("NSET");
    if (!builder_->KeepsNodeGroups() || name.empty()) return;
    if (in_assembly_ && !keyword.parameters.contains("INSTANCE")) return;
    const auto known = node_set_of_name_.try_emplace(InUpperCase(name), node_sets_.size());
    if (known.second) node_sets_.push_back({.name = name, .nodes = {}, .others = {}});
    node_set_ = known.first->second;
    generate_ = keyword.parameters.contains("GENERATE");
    take_ = &AbaqusReader::TakeNodeSet;
  }

  /// Numbers of nodes, names of other sets, which may follow, or with GENERATE first, last and
  /// step.
  void TakeNodeSet() {
    const auto parts = Split(line_);
    if (generate_) {
      if (parts.size() < 2 || parts.size() > 3) Fail("expected first, last and step");
      const int64_t step = parts.size() == 3 ? Integer(parts[2], "a step") : 1;
      AddNodeRange(Integer(parts[0], "a node"), Integer(parts[1], "a node"), step);
      return;
    }
    for (const std::string_view part : parts) {
      if (part.empty()) continue;
      if (std::isdigit(static_cast<unsigned char>(part.front())) == 0) {
        node_sets_[node_set_].others.push_back(InUpperCase(part));
      } else {
        AddToNodeSet(Integer(part, "a node"));
      }
    }
  }

  void AddNodeRange(int64_t first, int64_t last, int64_t step) {
    if (last < first) return;
    const int64_t steps = (last - first) / step;
    if (steps < static_cast<int64_t>(node_of_number_.size())) {
      for (int64_t k = 0; k <= steps; ++k) AddToNodeSet(first + k * step);
      return;
    }
    for (const auto& [number, node] : node_of_number_) {
      if (number >= first && number <= last && (number - first) % step == 0) AddToNodeSet(number);
    }
  }

  /// Numbers of nodes that are not there are passed over: a deck may name those of another part.
  void AddToNodeSet(int64_t number) {
    const auto node = node_of_number_.find(number);
    if (node != node_of_number_.end()) node_sets_[node_set_].nodes.push_back(node->second);
  }

  /// Names of sets are equal in any case. Returns `name` as the first set of that name has it.
  const std::string& NameOfSet(const std::string& name) {
    return names_of_sets_.try_emplace(InUpperCase(name), name).first->second;
  }

  /// Numbers of elements, names of other sets, or with GENERATE first, last and step. What they
  /// name may follow.
  void TakeSet() {
    const auto parts = Split(line_);
    if (generate_) {
      if (parts.size() < 2 || parts.size() > 3) Fail("expected first, last and step");
      const int64_t first = Integer(parts[0], "an element"), last = Integer(parts[1], "an element");
      const int64_t step = parts.size() == 3 ? Integer(parts[2], "a step") : 1;
      ranges_.push_back({listed_set_, first, last, step});
      return;
    }
    for (const std::string_view part : parts) {
      if (part.empty()) continue;
      if (std::isdigit(static_cast<unsigned char>(part.front())) == 0) {
        others_.emplace_back(*listed_set_, InUpperCase(part));
      } else if (const int64_t number = Integer(part, "an element");
                 !AddToSet(*listed_set_, number)) {
        ranges_.push_back({listed_set_, number, number, 1});
      }
    }
  }

  /// False: there is no such tetrahedron, or not yet.
  bool AddToSet(const std::string& set, int64_t number) {
    const auto tet = tet_of_number_.find(number);
    if (tet == tet_of_number_.end()) return false;
    tets_of_set_[set].push_back(tet->second);
    return true;
  }

  /// Elements first, first + step, ... to last of a set.
  struct Range {
    const std::string* set = nullptr;
    int64_t first = 0;
    int64_t last = 0;
    int64_t step = 1;
  };

  /// Elements that are no tetrahedra are in no group.
  void AddRange(const Range& range) {
    if (range.last < range.first) return;
    const int64_t steps = (range.last - range.first) / range.step;
    if (steps < static_cast<int64_t>(tet_of_number_.size())) {
      for (int64_t k = 0; k <= steps; ++k) AddToSet(*range.set, range.first + k * range.step);
      return;
    }
    for (const auto& [number, tet] : tet_of_number_) {
      const bool within =
          number >= range.first && number <= range.last && (number - range.first) % range.step == 0;
      if (within) tets_of_set_[*range.set].push_back(tet);
    }
  }

  /// Adds the elements of one set to another; whether that has become larger.
  bool AddSet(const std::string& set, const std::string& other_in_upper_case) {
    const auto other = names_of_sets_.find(other_in_upper_case);
    if (other == names_of_sets_.end() || set == other->second) return false;
    const auto from = tets_of_set_.find(other->second);
    if (from == tets_of_set_.end()) return false;
    return Unite(&tets_of_set_[set], &from->second);
  }

  /// Adds what `other` holds; whether `own` has become larger. Both are sorted.
  template <typename Index>
  static bool Unite(std::vector<Index>* own, std::vector<Index>* other) {
    for (std::vector<Index>* set : {own, other}) {
      std::sort(set->begin(), set->end());
      set->erase(std::unique(set->begin(), set->end()), set->end());
    }
    std::vector<Index> all;
    std::set_union(own->begin(), own->end(), other->begin(), other->end(), std::back_inserter(all));
    const bool larger = all.size() > own->size();
    *own = std::move(all);
    return larger;
  }

  /// Whether a node set has become larger by those that it names.
  bool GrowNodeSet(std::size_t set) {
    bool grows = false;
    for (const std::string& name : node_sets_[set].others) {
      const auto other = node_set_of_name_.find(name);
      if (other == node_set_of_name_.end() || other->second == set) continue;
      grows = Unite(&node_sets_[set].nodes, &node_sets_[other->second].nodes) || grows;
    }
    return grows;
  }

  void FinishNodeSets() {
    for (bool grows = true; grows;) {
      grows = false;
      for (std::size_t set = 0; set < node_sets_.size(); ++set) grows = GrowNodeSet(set) || grows;
    }
    for (const NodeSet& set : node_sets_) {
      const int group = builder_->NodeGroupNamed(set.name, 0);
      for (const int64_t& node : set.nodes) builder_->AddToNodeGroup(group, std::span(&node, 1));
    }
  }

  void FinishSets() {
    for (const Range& range : ranges_) AddRange(range);
    for (bool grows = true; grows;) {  // sets of sets, as deep as they go
      grows = false;
      for (const auto& [set, other] : others_) grows = AddSet(set, other) || grows;
    }
    for (const auto& [name, tets] : tets_of_set_) {
      if (name.empty()) continue;
      const int group = builder_->GroupNamed(name);
      for (const int tet : tets) builder_->AddToGroup(group, tet);
    }
  }

  std::string_view rest_;
  std::string_view line_;
  int line_number_ = 0;
  int keywords_ = 0;
  int parts_ = 0;
  int instances_ = 0;
  bool in_assembly_ = false;  ///< and outside its instance
  MeshBuilder* builder_;
  void (AbaqusReader::*take_)() = &AbaqusReader::PassOver;

  ElementType type_ = ElementType::kTet4;
  std::string set_;                          ///< that *ELEMENT names
  const std::string* listed_set_ = nullptr;  ///< of *ELSET
  bool generate_ = false;
  std::vector<int64_t> pending_;  ///< number and nodes of an element that is not complete
  int pending_line_ = 0;
  std::unordered_map<int64_t, int64_t> node_of_number_;
  struct NodeSet {
    std::string name;
    std::vector<int64_t> nodes;
    std::vector<std::string> others;  ///< names in upper case
  };
  std::vector<NodeSet> node_sets_;
  std::map<std::string, std::size_t> node_set_of_name_;  ///< by the name in upper case
  std::size_t node_set_ = 0;                             ///< of *NSET
  std::unordered_map<int64_t, int> tet_of_number_;
  std::map<std::string, std::string> names_of_sets_;  ///< of their names in upper case
  std::vector<Range> ranges_;
  std::vector<std::pair<std::string, std::string>> others_;  ///< a set, and one that it holds
  std::map<std::string, std::vector<int>> tets_of_set_;
};

}  // namespace

void ReadAbaqus(std::string_view bytes, MeshBuilder* builder) {
  AbaqusReader(bytes, builder).Read();
}

}  // namespace palpate::fem::mesh_io
