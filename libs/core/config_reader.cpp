// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/config_reader.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate {

namespace {

using Kind = ConfigNode::Kind;

std::string Describe(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::kNull: return "nothing";
    case Kind::kScalar:
      return node.quoted ? "the text '" + Excerpt(node.text) + "'" : "'" + Excerpt(node.text) + "'";
    case Kind::kList: return "a list of " + std::to_string(node.items.size());
    case Kind::kMap: return "a map";
  }
  return {};
}

[[noreturn]] void RefuseType(const ConfigNode& node, const std::string& wanted) {
  Refuse(node, "must be " + wanted + ", not " + Describe(node));
}

std::string Lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// What YAML 1.1 reads as a boolean, so that its writer may have meant either.
bool IsBooleanWord(const std::string& text) {
  static const std::set<std::string> words{"y", "n", "yes", "no", "on", "off", "true", "false"};
  return words.contains(Lowered(text));
}

bool IsNotFiniteWord(std::string text) {
  text = Lowered(std::move(text));
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.erase(0, 1);
  return text == ".inf" || text == ".nan" || text == "inf" || text == "nan" || text == "infinity";
}

/// A number with a leading zero (012): octal to some readers of YAML, decimal to others.
bool LooksOctal(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && std::isdigit(static_cast<unsigned char>(text[1]));
}

void RequirePlainNumber(const ConfigNode& node, const std::string& wanted) {
  if (node.kind != Kind::kScalar || node.quoted) RefuseType(node, wanted);
  if (IsNotFiniteWord(node.text)) Refuse(node, "must be finite, not '" + Excerpt(node.text) + "'");
  if (LooksOctal(node.text)) {
    Refuse(node, "'" + Excerpt(node.text) +
                     "' may mean octal or decimal: write it without the leading 0");
  }
}

void CheckRule(const ConfigNode& node, double value, const NumberRule& rule) {
  const bool low = rule.min_open ? value <= rule.min : value < rule.min;
  const bool high = rule.max_open ? value >= rule.max : value > rule.max;
  if (low || high) Refuse(node, "must be " + DescribeRule(rule) + ", not " + Excerpt(node.text));
}

}  // namespace

std::string DescribeRule(const NumberRule& rule) {
  std::string text;
  if (std::isfinite(rule.min)) text = (rule.min_open ? "> " : ">= ") + FormatNumber(rule.min);
  if (std::isfinite(rule.max)) {
    if (!text.empty()) text += " and ";
    text += (rule.max_open ? "< " : "<= ") + FormatNumber(rule.max);
  }
  return text;
}

void Refuse(const ConfigNode& node, const std::string& message) {
  throw InputError(node.where,
                   node.path.empty() ? message : "key '" + Excerpt(node.path) + "': " + message);
}

double ReadNumber(const ConfigNode& node, const NumberRule& rule) {
  RequirePlainNumber(node, "a number");
  double value = 0.0;
  if (!ParseFinite(node.text, &value)) RefuseType(node, "a number");
  CheckRule(node, value, rule);
  return value;
}

int ReadInteger(const ConfigNode& node, int min, int max) {
  RequirePlainNumber(node, "a whole number");
  int value = 0;
  const char* end = node.text.data() + node.text.size();
  const auto result = std::from_chars(node.text.data(), end, value);
  const bool too_big = result.ec == std::errc::result_out_of_range && result.ptr == end;
  if (!too_big && (result.ec != std::errc() || result.ptr != end)) {
    RefuseType(node, "a whole number");
  }
  if (too_big || value < min || value > max) {
    Refuse(node, "must be " + std::to_string(min) + " to " + std::to_string(max) + ", not " +
                     Excerpt(node.text));
  }
  return value;
}

bool ReadBool(const ConfigNode& node) {
  if (node.kind == Kind::kScalar && !node.quoted) {
    if (node.text == "true") return true;
    if (node.text == "false") return false;
  }
  RefuseType(node, "true or false");
}

std::string ReadText(const ConfigNode& node) {
  if (node.kind != Kind::kScalar) RefuseType(node, "text");
  double number = 0.0;
  const bool ambiguous =
      IsBooleanWord(node.text) || IsNotFiniteWord(node.text) || ParseFinite(node.text, &number);
  if (!node.quoted && ambiguous) {
    Refuse(node, "must be text, and YAML reads " + Excerpt(node.text) +
                     " as something else: write \"" + Excerpt(node.text) + "\"");
  }
  return node.text;
}

std::string ReadChoice(const ConfigNode& node, const std::vector<std::string>& choices) {
  if (node.kind != Kind::kScalar) RefuseType(node, "text");
  if (std::find(choices.begin(), choices.end(), node.text) != choices.end()) return node.text;
  Refuse(node, "must be one of " + Listed(choices) + ", not '" + Excerpt(node.text) + "'" +
                   DidYouMean(node.text, choices));
}

Eigen::Vector3d ReadVector3(const ConfigNode& node, const NumberRule& rule) {
  if (node.kind != Kind::kList || node.items.size() != 3) RefuseType(node, "a list of 3 numbers");
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector(i) = ReadNumber(node.items[At(i)], rule);
  return vector;
}

std::vector<double> ReadNumbers(const ConfigNode& node, const NumberRule& rule) {
  if (node.kind != Kind::kList) RefuseType(node, "a list of numbers");
  std::vector<double> numbers;
  for (const ConfigNode& item : node.items) numbers.push_back(ReadNumber(item, rule));
  return numbers;
}

Eigen::Matrix3Xd ReadPoints(const ConfigNode& node) {
  if (node.kind != Kind::kList) RefuseType(node, "a list of points [x, y, z]");
  Eigen::Matrix3Xd points(3, ToIndex(node.items.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points.col(i) = ReadVector3(node.items[At(i)]);
  }
  return points;
}

MapReader::MapReader(const ConfigNode& node) : node_(node) {
  if (node.kind != Kind::kMap) RefuseType(node, "a map");
  std::set<std::string> seen;
  for (const auto& [key, entry] : node.entries) {
    if (!seen.insert(key).second) {
      throw InputError(entry.key_where, "key '" + entry.path + "' is given twice");
    }
  }
}

MapReader::MapReader(const ConfigNode& node, const KeyTable& keys) : MapReader(node) {
  keys_ = &keys;
  RefuseForeignUnits(node, keys);
}

const ConfigNode& MapReader::Require(const std::string& key) {
  const ConfigNode* entry = Optional(key);
  if (entry != nullptr) return *entry;
  if (const ConfigNode* empty = node_.Find(key)) Refuse(*empty, "must have a value");
  std::vector<std::string> unknown_keys;
  for (const auto& [name, unused] : node_.entries) {
    if (!IsKnown(name)) unknown_keys.push_back(name);
  }
  const std::string near = Nearest(key, unknown_keys);
  Refuse(node_, "key '" + key + "' is missing" +
                    (near.empty() ? "" : " (did you mean it by '" + near + "'?)"));
}

const ConfigNode* MapReader::Optional(const std::string& key) {
  PALPATE_CHECK(keys_ == nullptr || keys_->Find(key) != nullptr, key, "is not in the table");
  if (!IsKnown(key)) known_keys_.push_back(key);
  const ConfigNode* entry = node_.Find(key);
  return entry == nullptr || entry->kind == Kind::kNull ? nullptr : entry;
}

void MapReader::Finish() const {
  if (keys_ != nullptr) {
    for (const Key& key : keys_->keys) {
      PALPATE_CHECK(!key.presence.IsUnconditional() || IsKnown(key.name), keys_->title, key.name,
                    "is in the table and was not asked for");
    }
  }
  for (const auto& [key, entry] : node_.entries) {
    if (!IsKnown(key)) {
      throw InputError(entry.key_where, "unknown key '" + Excerpt(entry.path) + "'" +
                                            DidYouMean(key, known_keys_) +
                                            "; allowed: " + Listed(known_keys_));
    }
  }
}

double MapReader::Number(const std::string& key, double fallback, const NumberRule& rule) {
  const ConfigNode* entry = Optional(key);
  return entry == nullptr ? fallback : ReadNumber(*entry, rule);
}

bool MapReader::IsKnown(const std::string& key) const {
  return std::find(known_keys_.begin(), known_keys_.end(), key) != known_keys_.end();
}

const Key& MapReader::KeyOf(const std::string& key) const {
  PALPATE_CHECK(keys_ != nullptr && keys_->Find(key) != nullptr, key, "is not in the table");
  return *keys_->Find(key);
}

const ConfigNode* MapReader::Entry(const std::string& key) {
  return KeyOf(key).presence.MustBeThere() ? &Require(key) : Optional(key);
}

void MapReader::Read(const std::string& key, bool* value) {
  if (const ConfigNode* entry = Entry(key)) *value = ReadBool(*entry);
}

void MapReader::Read(const std::string& key, int* value) {
  const NumberRule& rule = KeyOf(key).type.rule;
  const ConfigNode* entry = Entry(key);
  if (entry == nullptr) return;
  *value = ReadInteger(*entry, static_cast<int>(rule.min), static_cast<int>(rule.max));
}

void MapReader::Read(const std::string& key, double* value) {
  if (const ConfigNode* entry = Entry(key)) *value = ReadNumber(*entry, KeyOf(key).type.rule);
}

void MapReader::Read(const std::string& key, std::string* value) {
  const std::vector<std::string>& choices = KeyOf(key).type.choices;
  const ConfigNode* entry = Entry(key);
  if (entry == nullptr) return;
  *value = choices.empty() ? ReadText(*entry) : ReadChoice(*entry, choices);
}

void MapReader::Read(const std::string& key, Eigen::Vector3d* value) {
  const ConfigNode* entry = Entry(key);
  if (entry != nullptr) *value = ReadVector3(*entry, KeyOf(key).type.parts.at(0).rule);
}

void MapReader::Read(const std::string& key, std::optional<double>* value) {
  if (const ConfigNode* entry = Entry(key)) *value = ReadNumber(*entry, KeyOf(key).type.rule);
}

void MapReader::Read(const std::string& key, std::optional<Eigen::Vector3d>* value) {
  const ConfigNode* entry = Entry(key);
  if (entry != nullptr) *value = ReadVector3(*entry, KeyOf(key).type.parts.at(0).rule);
}

void MapReader::Read(const std::string& key, std::filesystem::path* value) {
  const ConfigNode* entry = Entry(key);
  if (entry == nullptr) return;
  const std::filesystem::path folder = std::filesystem::path(entry->where.file).parent_path();
  *value = (folder / ReadText(*entry)).lexically_normal();
}

}  // namespace palpate
