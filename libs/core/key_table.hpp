// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/number_rule.hpp"

namespace palpate {

struct KeyTable;

/// What may stand as a value in a file of settings.
struct ValueType {
  enum class Kind { kBoolean, kInteger, kNumber, kText, kFile, kList, kMap, kEither };

  Kind kind = Kind::kText;
  NumberRule rule{};                   ///< of a kInteger or kNumber
  std::vector<std::string> choices{};  ///< of a kText; empty: any text
  std::vector<ValueType> parts{};      ///< kList: the type of an item; kEither: the alternatives
  int min_items = 0;                   ///< of a kList
  int max_items = kUnlimited;
  const KeyTable* keys = nullptr;  ///< of a kMap; lives as long as the program
  bool may_be_null = false;        ///< `~` is a value with a meaning of its own

  static constexpr int kUnlimited = 1 << 30;
};

namespace value {

ValueType Boolean();
ValueType WholeNumber(int min, int max);  ///< both included
ValueType Real(const NumberRule& rule = kAnyNumber);
ValueType Text();
ValueType Choice(std::vector<std::string> choices);
/// A path; a relative one counts from the folder of the file that names it.
ValueType File();
ValueType Vector3(const NumberRule& rule = kAnyNumber);  ///< [x, y, z]
ValueType Numbers(const NumberRule& rule = kAnyNumber, int min_items = 0,
                  int max_items = ValueType::kUnlimited);
/// [[x, y, z], ...]
ValueType Points(int min_items = 0, int max_items = ValueType::kUnlimited);
ValueType List(ValueType item, int min_items = 0);
ValueType Map(const KeyTable& keys);
ValueType ListOfMaps(const KeyTable& keys, int min_items = 0);
ValueType Either(std::vector<ValueType> alternatives);
ValueType OrNull(ValueType type);

}  // namespace value

/// Whether a key must stand in the file, and what holds where it does not.
struct Presence {
  enum class Kind {
    kRequired,
    kOptional,
    kRequiredIf,  ///< required where a reader asks for it, refused elsewhere
    kOptionalIf,  ///< optional where a reader asks for it, refused elsewhere
  };

  Kind kind = Kind::kOptional;
  std::string text;  ///< for people: the default as YAML, or the condition; may be empty
  std::string json;  ///< the default as JSON; empty: none

  bool MustBeThere() const { return kind == Kind::kRequired || kind == Kind::kRequiredIf; }
  /// Whether every reader asks for the key, whatever the other keys are.
  bool IsUnconditional() const { return kind == Kind::kRequired || kind == Kind::kOptional; }
};

extern const Presence kRequired;
extern const Presence kOptional;  ///< without a default: `meaning` says what absence means
Presence RequiredFor(const std::string& condition);  ///< "shape: sphere"
Presence OnlyFor(const std::string& condition);      ///< optional there, refused elsewhere
Presence OnlyFor(const std::string& condition, Presence with_default);
/// Optional with a default, which is best taken from a default-constructed settings struct.
Presence Default(double value);
Presence Default(int value);
Presence Default(bool value);
Presence Default(const char* word);
Presence Default(const Eigen::VectorXd& vector);

/// One key of a map in a file. This line is the only place with its type, range and meaning:
/// reading, error messages, the Markdown reference and the JSON Schema are made from it.
struct Key {
  std::string name;  ///< of an open key (KeyTable::open_keys): "<cable>.displacement_m"
  ValueType type;
  Presence presence;
  std::string meaning;  ///< for people: what, frame, sign, what absence means
};

/// The keys that one map may have.
struct KeyTable {
  std::string title;
  std::string about;  ///< for people: what the map is, and rules that tie keys together
  std::vector<Key> keys{};
  /// Keys whose beginning the user chooses: any text, then what follows the '>' of the name.
  std::vector<Key> open_keys{};
  /// Of each of these groups exactly one key stands in the map.
  std::vector<std::vector<std::string>> exactly_one{};
  /// Of each of these groups no more than one key does.
  std::vector<std::vector<std::string>> at_most_one{};

  /// The key of that name, also an open one; nullptr where there is none.
  const Key* Find(std::string_view name) const;
};

/// The unit in which a key's name ends, for people: "m/s²" of "gravity_m_s2"; empty without one.
std::string UnitOf(std::string_view key);

/// Throws InputError at a key of `map` that is one of `keys` in another unit ("path_mm"), or
/// without one, and names the key that fits.
void RefuseForeignUnits(const ConfigNode& map, const KeyTable& keys);

}  // namespace palpate
