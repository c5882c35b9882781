// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recording {

namespace {

const std::map<std::string, std::string>& Primitives() {
  static const std::map<std::string, std::string> kPrimitives{
      {"boolean", "bool"},         {"octet", "uint8"},           {"char", "uint8"},
      {"short", "int16"},          {"unsigned short", "uint16"}, {"long", "int32"},
      {"unsigned long", "uint32"}, {"long long", "int64"},       {"unsigned long long", "uint64"},
      {"float", "float32"},        {"double", "float64"},        {"string", "string"}};
  return kPrimitives;
}

/// Words with their scopes ("a::b"), and single other characters.
std::vector<std::string> TokensOf(std::string_view text) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < text.size();) {
    if (std::isspace(static_cast<unsigned char>(text[i]))) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && (is_word(text[end]) || (end > i && text.substr(end, 2) == "::"))) {
      end += text.substr(end, 2) == "::" ? 2 : 1;
    }
    end = std::max(end, i + 1);
    tokens.emplace_back(text.substr(i, end - i));
    i = end;
  }
  return tokens;
}

class OmgIdlParser {
 public:
  explicit OmgIdlParser(std::string_view text) : tokens_(TokensOf(text)) {}

  Definitions Run() && {
    while (at_ < tokens_.size()) Definition();
    return std::move(definitions_);
  }

 private:
  [[noreturn]] static void Refuse(const std::string& what) {
    throw InputError("the type's structure: " + what);
  }

  std::string Next() {
    if (at_ == tokens_.size()) Refuse("ends early");
    return tokens_[at_++];
  }
  bool Takes(std::string_view token) {
    if (at_ == tokens_.size() || tokens_[at_] != token) return false;
    ++at_;
    return true;
  }
  void Expect(std::string_view token) {
    const std::string found = Next();
    if (found != token) Refuse("has '" + Excerpt(found) + "' for '" + std::string(token) + "'");
  }
  std::uint32_t Count() {
    const std::string word = Next();
    const bool digits =
        !word.empty() && word.size() < 10 &&
        std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!digits) Refuse("has '" + Excerpt(word) + "' for a number");
    return static_cast<std::uint32_t>(std::stoul(word));
  }

  void Definition() {
    if (Takes("}")) {
      Expect(";");
      if (scopes_.empty()) Refuse("closes more than it opens");
      scopes_.pop_back();
    } else if (Takes("module")) {
      scopes_.push_back(Next());
      Expect("{");
    } else if (Takes("struct")) {
      Struct();
    } else if (Takes("enum")) {
      Enumeration();
    } else if (Takes("typedef")) {
      Typedef();
    } else {
      Annotation();
    }
  }

  void Annotation() {
    Expect("@");
    const std::string name = Next();
    if (name == "mutable") Refuse("is mutable, which is not read");
    if (name == "optional") Refuse("has an optional member, which is not read");
    if (!Takes("(")) return;
    while (!Takes(")")) Next();
  }

  std::string Scoped(const std::string& name) const {
    std::string scoped;
    for (const std::string& scope : scopes_) scoped += scope + "::";
    return scoped + name;
  }

  void Struct() {
    MessageDefinition definition{Scoped(Next()), {}, {}};
    if (Takes(":")) {
      const auto base = definitions_.find(Next());
      if (base == definitions_.end()) Refuse("has an unknown base");
      definition.fields = base->second.fields;
    }
    Expect("{");
    while (!Takes("}")) {
      if (tokens_[at_] == "@") {
        Annotation();
      } else {
        definition.fields.push_back(Member());
      }
    }
    Expect(";");
    definitions_[definition.name] = std::move(definition);
  }

  void Enumeration() {
    const std::string name = Scoped(Next());
    Expect("{");
    while (!Takes("}")) Next();
    Expect(";");
    aliases_[name] = {"int32", "", Repeat::kOne, 0};
  }

  void Typedef() {
    Field field = Member();
    const std::string name = Scoped(std::exchange(field.name, ""));
    aliases_[name] = std::move(field);
  }

  /// "sequence<double, 3> name;", "double name[3][4];"
  Field Member() {
    Field field = Type();
    field.name = Next();
    while (Takes("[")) {
      const std::uint32_t count = Count();
      Expect("]");
      if (field.repeat == Repeat::kSequence) Refuse("has an array of sequences, which is not read");
      field.count = (field.repeat == Repeat::kFixed ? field.count : 1) * count;
      field.repeat = Repeat::kFixed;
    }
    Expect(";");
    return field;
  }

  Field Type() {
    if (Takes("sequence")) {
      Expect("<");
      Field field = Type();
      if (field.repeat != Repeat::kOne) Refuse("has nested sequences, which are not read");
      if (Takes(",")) Count();
      Expect(">");
      field.repeat = Repeat::kSequence;
      return field;
    }
    std::string name = Next();
    while (name == "unsigned" || name == "long" || name == "unsigned long") {
      if (at_ == tokens_.size() || (tokens_[at_] != "long" && tokens_[at_] != "short")) break;
      name += " " + Next();
    }
    if (name == "string" && Takes("<")) {
      Count();
      Expect(">");
    }
    if (const auto known = Primitives().find(name); known != Primitives().end()) {
      return {known->second, "", Repeat::kOne, 0};
    }
    if (const auto alias = aliases_.find(name); alias != aliases_.end()) return alias->second;
    if (!definitions_.contains(name)) Refuse("has the unknown type '" + Excerpt(name) + "'");
    return {name, "", Repeat::kOne, 0};
  }

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> scopes_;
  Definitions definitions_;
  std::map<std::string, Field> aliases_;
};

}  // namespace

Definitions ParseOmgIdl(std::string_view text) { return OmgIdlParser(text).Run(); }

}  // namespace palpate::recording
