// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/formula_values.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "components/capture/aravis/dom_text.hpp"
#include "components/capture/aravis/gobject.hpp"
#include "libs/core/text.hpp"

namespace palpate::capture {

namespace {

constexpr int kDeepestFormula = 16;

/// The first child element of that name; nullptr: none.
ArvDomNode* ChildNamed(ArvGcNode* node, std::string_view name) {
  for (ArvDomNode* child = arv_dom_node_get_first_child(ARV_DOM_NODE(node)); child != nullptr;
       child = arv_dom_node_get_next_sibling(child)) {
    const char* own = arv_dom_node_get_node_name(child);
    if (ARV_IS_DOM_ELEMENT(child) && own != nullptr && own == name) return child;
  }
  return nullptr;
}

}  // namespace

/// A node that computes its value.
struct FormulaValues::Formula {
  std::string text;
  bool of_integers = false;
  std::vector<std::pair<std::string, std::string>> variables;  ///< name, node that has the value
  std::vector<std::pair<std::string, double>> constants;
  std::vector<std::pair<std::string, std::string>> expressions;  ///< name, formula

  /// nullopt where the node has no formula.
  static std::optional<Formula> Of(ArvGcNode* node) {
    const bool converts = ARV_IS_GC_CONVERTER(node);
    if (!ARV_IS_GC_SWISS_KNIFE(node) && !converts) return std::nullopt;
    ArvDomNode* text = ChildNamed(node, converts ? "FormulaFrom" : "Formula");
    if (text == nullptr) return std::nullopt;
    Formula formula;
    formula.text = TextOf(text);
    formula.of_integers =
        ARV_IS_GC_INT_SWISS_KNIFE_NODE(node) || ARV_IS_GC_INT_CONVERTER_NODE(node);
    for (ArvDomNode* child = arv_dom_node_get_first_child(ARV_DOM_NODE(node)); child != nullptr;
         child = arv_dom_node_get_next_sibling(child)) {
      if (ARV_IS_DOM_ELEMENT(child)) formula.TakeInput(child, converts);
    }
    return formula;
  }

  void TakeInput(ArvDomNode* element, bool converts) {
    const std::string_view kind = arv_dom_node_get_node_name(element);
    const char* attribute = arv_dom_element_get_attribute(ARV_DOM_ELEMENT(element), "Name");
    const std::string name = attribute == nullptr ? "" : attribute;
    double number = 0.0;
    if (kind == "pVariable") {
      variables.emplace_back(name, TextOf(element));
    } else if (kind == "pValue" && converts) {
      variables.emplace_back("TO", TextOf(element));
    } else if (kind == "Constant" && ParseFinite(TextOf(element), &number)) {
      constants.emplace_back(name, number);
    } else if (kind == "Expression") {
      expressions.emplace_back(name, TextOf(element));
    }
  }

  GObjectPtr<ArvEvaluator> MakeEvaluator() const {
    GObjectPtr<ArvEvaluator> evaluator(arv_evaluator_new(text.c_str()));
    for (const auto& [name, number] : constants) {
      arv_evaluator_set_double_variable(evaluator.get(), name.c_str(), number);
    }
    for (const auto& [name, expression] : expressions) {
      arv_evaluator_set_sub_expression(evaluator.get(), name.c_str(), expression.c_str());
    }
    return evaluator;
  }

  /// Whether Aravis refuses it whatever the values are.
  bool Fails() const {
    if (!of_integers) return false;
    const auto evaluator = MakeEvaluator();
    for (const auto& [name, node] : variables) {
      arv_evaluator_set_int64_variable(evaluator.get(), name.c_str(), 1);
    }
    GErrorHolder error;
    arv_evaluator_evaluate_as_int64(evaluator.get(), error.Take());
    return error.text().find("invalid double function") != std::string::npos;
  }
};

ArvGcNode* FormulaValues::Find(const std::string& name) const {
  return arv_device_get_feature(device_, name.c_str());
}

void FormulaValues::Note(const std::string& note) {
  if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
}

bool FormulaValues::Fails(ArvGcNode* feature) {
  const char* name = arv_gc_feature_node_get_name(ARV_GC_FEATURE_NODE(feature));
  if (name == nullptr) return false;
  const auto [entry, is_new] = fails_.try_emplace(name, false);
  if (is_new) entry->second = Fails(feature, 0);
  return entry->second;
}

bool FormulaValues::Fails(ArvGcNode* node, int depth) {
  if (node == nullptr || depth > kDeepestFormula) return false;
  if (const auto formula = Formula::Of(node)) {
    return formula->Fails() ||
           std::any_of(formula->variables.begin(), formula->variables.end(),
                       [&](const auto& input) { return Fails(Find(input.second), depth + 1); });
  }
  ArvDomNode* link = ChildNamed(node, "pValue");
  return link != nullptr && Fails(Find(TextOf(link)), depth + 1);
}

std::optional<double> FormulaValues::Value(ArvGcNode* feature) {
  const std::optional<double> value = Value(feature, 0);
  const char* name = arv_gc_feature_node_get_name(ARV_GC_FEATURE_NODE(feature));
  const std::string intro = std::string("the camera computes ") + (name != nullptr ? name : "?");
  if (value) {
    Note(intro + " by a formula that is evaluated in real numbers: " + FormatNumber(*value));
  } else {
    Note(intro + " by a formula that cannot be evaluated: it counts as not told");
  }
  return value;
}

std::optional<double> FormulaValues::Value(ArvGcNode* node, int depth) {
  if (node == nullptr || depth > kDeepestFormula) return std::nullopt;
  if (const auto formula = Formula::Of(node)) return ValueOfFormula(*formula, depth);
  if (ArvDomNode* link = ChildNamed(node, "pValue")) {
    if (Fails(Find(TextOf(link)), depth + 1)) return Value(Find(TextOf(link)), depth + 1);
  }
  GErrorHolder error;
  std::optional<double> value;
  if (ARV_IS_GC_FLOAT(node)) {
    value = arv_gc_float_get_value(ARV_GC_FLOAT(node), error.Take());
  } else if (ARV_IS_GC_INTEGER(node)) {
    value = static_cast<double>(arv_gc_integer_get_value(ARV_GC_INTEGER(node), error.Take()));
  }
  return error.ok() ? value : std::nullopt;
}

std::optional<double> FormulaValues::ValueOfFormula(const Formula& formula, int depth) {
  const auto evaluator = formula.MakeEvaluator();
  const bool as_integer = formula.of_integers && !formula.Fails();
  for (const auto& [name, node] : formula.variables) {
    const std::optional<double> value = Value(Find(node), depth + 1);
    if (!value) return std::nullopt;
    if (as_integer) {
      arv_evaluator_set_int64_variable(evaluator.get(), name.c_str(),
                                       static_cast<std::int64_t>(*value));
    } else {
      arv_evaluator_set_double_variable(evaluator.get(), name.c_str(), *value);
    }
  }
  GErrorHolder error;
  const double value =
      as_integer
          ? static_cast<double>(arv_evaluator_evaluate_as_int64(evaluator.get(), error.Take()))
          : arv_evaluator_evaluate_as_double(evaluator.get(), error.Take());
  return error.ok() ? std::optional(value) : std::nullopt;
}

}  // namespace palpate::capture
