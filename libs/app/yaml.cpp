// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <optional>
#include <sstream>

#include "libs/core/check.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

SourceLocation Locate(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file};
  return {file, mark.line + 1, mark.column + 1};
}

/// Builds the tree from the parser's events. Events rather than YAML::Node, because a Node forgets
/// which of two equal keys came first and whether a scalar was quoted.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) { root_.where.file = file_; }

  ConfigNode TakeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Add(Kind::kNull, mark, "?", anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw InputError(Locate(file_, mark), "aliases (*name) are not read: write the value out");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool is_key = !open_.empty() && open_.back()->kind == Kind::kMap && !key_;
    if (is_key) {
      TakeKey(mark, tag, anchor, value);
      return;
    }
    ConfigNode* node = Add(Kind::kScalar, mark, tag, anchor);
    node->text = value;
    node->quoted = tag == "!";
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back(Add(Kind::kList, mark, tag, anchor));
  }
  void OnSequenceEnd() override { open_.pop_back(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back(Add(Kind::kMap, mark, tag, anchor));
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  using Kind = ConfigNode::Kind;

  void RefuseExtras(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) const {
    const SourceLocation where = Locate(file_, mark);
    if (anchor != YAML::NullAnchor) throw InputError(where, "anchors (&name) are not read");
    if (!tag.empty() && tag != "?" && tag != "!") {
      throw InputError(where, "tags (" + Excerpt(tag) + ") are not read");
    }
  }

  void TakeKey(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
               const std::string& key) {
    RefuseExtras(mark, tag, anchor);
    if (open_.back()->Find(key) != nullptr) {
      throw InputError(Locate(file_, mark), "key '" + Excerpt(ChildPath(key)) +
                                                "' is given twice, first " +
                                                open_.back()->Find(key)->key_where.ToString());
    }
    key_ = key;
    key_where_ = Locate(file_, mark);
  }

  std::string ChildPath(const std::string& key) const {
    const std::string& parent = open_.back()->path;
    return parent.empty() ? key : parent + "." + key;
  }

  /// Appends a node to the innermost open list or map. Valid until the next sibling is added,
  /// which happens only after the node is closed.
  ConfigNode* Add(Kind kind, const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor) {
    RefuseExtras(mark, tag, anchor);
    ConfigNode node;
    node.kind = kind;
    node.where = Locate(file_, mark);
    if (open_.empty()) {
      root_ = std::move(node);
      return &root_;
    }
    ConfigNode& parent = *open_.back();
    if (parent.kind == Kind::kList) {
      node.path = parent.path + "[" + std::to_string(parent.items.size()) + "]";
      return &parent.items.emplace_back(std::move(node));
    }
    if (!key_) throw InputError(node.where, "a key must be a plain word");
    node.path = ChildPath(*key_);
    node.key_where = key_where_;
    parent.entries.push_back({*key_, std::move(node)});
    key_.reset();
    return &parent.entries.back().value;
  }

  std::string file_;
  ConfigNode root_;
  std::vector<ConfigNode*> open_;   // lists and maps that have not ended, outermost first
  std::optional<std::string> key_;  // of the innermost map, waiting for its value
  SourceLocation key_where_;
};

/// The first line (from 1) whose indentation holds a tab; 0: none.
int FindTabIndent(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t content = line.find_first_not_of(" \t");
    const std::size_t tab = line.find('\t');
    if (content != std::string::npos && tab < content) return number;
  }
  return 0;
}

}  // namespace

ConfigNode ParseYaml(const std::string& text, const std::string& name) {
  TreeBuilder builder(name);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return builder.TakeRoot();
    // The tools of ROS print '---' behind each message: an empty document at the end is none.
    TreeBuilder second(name);
    if (parser.HandleNextDocument(second)) {
      const ConfigNode root = second.TakeRoot();
      if (root.kind != ConfigNode::Kind::kNull || parser.HandleNextDocument(second)) {
        throw InputError(root.where, "only one YAML document is read from a file");
      }
    }
  } catch (const YAML::Exception& error) {
    const int tab_line = FindTabIndent(text);
    const bool tab_before = tab_line > 0 && tab_line <= error.mark.line + 1;
    if (tab_before) {
      throw InputError({name, tab_line, 1},
                       "not valid YAML: the line is indented by a tab; use spaces");
    }
    throw InputError(Locate(name, error.mark), "not valid YAML: " + Excerpt(error.msg));
  }
  return builder.TakeRoot();
}

ConfigNode LoadYaml(const std::filesystem::path& file) {
  const std::string text = ReadFile(file);
  const std::string extension = file.extension().string();
  const bool is_named_yaml = extension == ".yaml" || extension == ".yml";
  const std::string name_hint =
      is_named_yaml ? "" : "; a YAML file is expected here, whose name ends in .yaml";
  if (text.find('\0') != std::string::npos) {
    throw InputError(SourceLocation{file.string()}, "is a binary file, not YAML" + name_hint);
  }
  try {
    ConfigNode root = ParseYaml(text, file.string());
    if (root.kind != ConfigNode::Kind::kScalar) return root;
    throw InputError(root.where, "is no file of settings (key: value), it begins with '" +
                                     Excerpt(root.text) + "'");
  } catch (const InputError& error) {
    if (is_named_yaml) throw;
    throw InputError(error.what() + name_hint);
  }
}

}  // namespace palpate::app
