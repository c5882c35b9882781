// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>

#include <string>

#include "components/palpate/doctor/check.hpp"

namespace palpate::command {

/// A check of this grade, with parts of what it found and of its remedy; empty: it has none.
inline testing::Matcher<const Check&> Is(Grade grade, const std::string& finding,
                                         const std::string& remedy = {}) {
  using testing::HasSubstr;
  return testing::AllOf(testing::Field("grade", &Check::grade, grade),
                        testing::Field("finding", &Check::finding, HasSubstr(finding)),
                        remedy.empty()
                            ? testing::Field("remedy", &Check::remedy, "")
                            : testing::Field("remedy", &Check::remedy, HasSubstr(remedy)));
}

}  // namespace palpate::command
