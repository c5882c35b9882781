// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace palpate::capture {

/// Values of features that a device computes by formulas which Aravis cannot evaluate. Aravis 0.8
/// evaluates formulas of integers (IntSwissKnife, IntConverter) without the functions of real
/// numbers, such as ROUND and CEIL, and reads 0 for them without an error. The device must outlive
/// this.
class FormulaValues {
 public:
  explicit FormulaValues(ArvDevice* device) : device_(device) {}

  /// Whether Aravis cannot evaluate a formula that the feature's value depends on.
  bool Fails(ArvGcNode* feature);
  /// The value with such formulas evaluated in real numbers; nullopt where that fails, too.
  std::optional<double> Value(ArvGcNode* feature);
  /// What was computed in this way, and what could not be, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Formula;

  ArvGcNode* Find(const std::string& name) const;
  bool Fails(ArvGcNode* node, int depth);
  std::optional<double> Value(ArvGcNode* node, int depth);
  std::optional<double> ValueOfFormula(const Formula& formula, int depth);
  void Note(const std::string& note);

  ArvDevice* device_;
  std::map<std::string, bool> fails_;  ///< by name, of the features that were asked for
  std::vector<std::string> notes_;
};

}  // namespace palpate::capture
