// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/kept_record.hpp"

#include <gtest/gtest.h>

#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::blind {
namespace {

constexpr char kHow[] = "--samples 60";

CaseRecord Case() {
  return {.seed = 7,
          .kind = CaseKind::kTwoCauses,
          .sizes_m = {3.125e-4, 2e-3},
          .no_verdict = "exit code 1: \"no balance\"",
          .diagnosis_s = 91.5};
}

TEST(KeptRecord, IsWhatItWas) {
  const test_support::TestFolder folder;
  KeepRecord(Case(), kHow, folder.path() / "record.json");
  CaseRecord record{.seed = 7, .kind = CaseKind::kTwoCauses};
  ASSERT_TRUE(ReadKeptRecord(folder.path() / "record.json", kHow, &record));
  EXPECT_EQ(record.sizes_m, Case().sizes_m);
  EXPECT_EQ(record.not_made, "");
  EXPECT_EQ(record.no_verdict, Case().no_verdict);
  EXPECT_EQ(record.diagnosis_s, Case().diagnosis_s);
}

TEST(KeptRecord, IsNotTakenWhereTheDiagnosisWasAskedOtherwise) {
  const test_support::TestFolder folder;
  KeepRecord(Case(), kHow, folder.path() / "record.json");
  CaseRecord record;
  EXPECT_FALSE(ReadKeptRecord(folder.path() / "record.json", "--samples 120", &record));
  EXPECT_TRUE(record.sizes_m.empty());
}

TEST(KeptRecord, IsNotTakenWhereItIsNotThereOrCutShort) {
  const test_support::TestFolder folder;
  CaseRecord record;
  EXPECT_FALSE(ReadKeptRecord(folder.path() / "record.json", kHow, &record));
  KeepRecord(Case(), kHow, folder.path() / "record.json");
  const std::string whole = ReadFile(folder.path() / "record.json");
  for (const std::string& bytes :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
        std::string("{\"how\": 60}"), std::string("{\"how\": \"--samples 60\"}")}) {
    WriteFile(folder.path() / "record.json", bytes);
    EXPECT_FALSE(ReadKeptRecord(folder.path() / "record.json", kHow, &record)) << bytes;
  }
}

}  // namespace
}  // namespace palpate::blind
