// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <string>
#include <utility>
#include <vector>

#include "components/capture/aravis/formula_values.hpp"
#include "components/capture/genicam/features.hpp"

namespace palpate::capture {

/// The features of a device that Aravis opened. The device must outlive this.
class AravisFeatures : public Features {
 public:
  explicit AravisFeatures(ArvDevice* device) : device_(device), formulas_(device) {}

  bool Has(const std::string& name) override;
  std::optional<double> Number(const std::string& name) override;
  std::optional<std::int64_t> Integer(const std::string& name) override;
  std::optional<bool> Bool(const std::string& name) override;
  std::optional<std::string> Text(const std::string& name) override;
  std::vector<std::pair<std::string, std::int64_t>> Choices(const std::string& name) override;
  std::optional<std::pair<std::int64_t, std::int64_t>> Range(const std::string& name) override;
  Status Set(const std::string& name, const FeatureValue& value) override;
  Status Execute(const std::string& command) override;
  std::vector<std::string> Notes() const override { return formulas_.notes(); }

 private:
  ArvGcNode* Node(const std::string& name);
  static bool IsUsable(ArvGcNode* node);
  static Status SetFloat(ArvGcFloat* node, double number);

  ArvDevice* device_;
  FormulaValues formulas_;
};

}  // namespace palpate::capture
