// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// For people: so many significant digits, plain decimals; "not known" where it is not finite.
std::string NumberText(double value, int digits);

/// A length in millimetres, two significant digits: "4.1".
std::string MillimetreText(double value_m);

/// A length in millimetres with its unit: "4.1 mm"; "not known".
std::string LengthText(double value_m);

/// "0.97"; small ones as "< 0.001", so that nothing is called impossible.
std::string ProbabilityText(double probability);

/// "83 %"
std::string PercentText(double share);

/// How a parameter is shown; its name ends in its SI unit (docs/diagnosis.md).
struct ParameterText {
  std::string name;      ///< "offset"
  std::string unit;      ///< "mm"; empty: a plain number
  std::string value;     ///< "2.1"
  std::string interval;  ///< "1.8 to 2.4"
  std::string whole;     ///< "offset = 2.1 ± 0.3 mm"; an interval where it is lopsided
};
ParameterText DescribeParameter(const FittedParameter& parameter);

}  // namespace palpate::diagnosis
