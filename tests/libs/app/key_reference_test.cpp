// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/key_reference.hpp"

#include <gmock/gmock.h>

namespace palpate::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const KeyTable& PointKeys() {
  static const KeyTable keys{.title = "point",
                             .about = "A point.",
                             .keys = {{"at_m", value::Vector3(), kRequired, "Where it is."}}};
  return keys;
}

const KeyTable& BodyKeys() {
  static const KeyTable keys{
      .title = "body",
      .about = "A body.",
      .keys = {{"mass_kg", value::Real(kPositive), kOptional, "Its mass."},
               {"density_kg_m3", value::Real(kPositive), kOptional, "Its density."},
               {"element", value::Choice({"tet4", "tet10"}), Default("tet10"), "Element."},
               {"first", value::Map(PointKeys()), kRequired, "One point."},
               {"points", value::ListOfMaps(PointKeys(), 1), kOptional, "More of them."}},
      .open_keys = {{"<cable>.pull_N", value::OrNull(value::Real()), kOptional, "A pull."}},
      .exactly_one = {{"mass_kg", "density_kg_m3"}}};
  return keys;
}

TEST(KeyReference, PrintsTablesAndEachMapOnce) {
  EXPECT_EQ(PrintKeysMarkdown({&BodyKeys()}),
            "### body\n\n"
            "A body. Exactly one of `mass_kg`, `density_kg_m3`.\n\n"
            "| key | type and range | unit | default | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `mass_kg` | number > 0 | kg | optional | Its mass. |\n"
            "| `density_kg_m3` | number > 0 | kg/m³ | optional | Its density. |\n"
            "| `element` | `tet4`, `tet10` |  | `tet10` | Element. |\n"
            "| `first` | [point](#point) |  | required | One point. |\n"
            "| `points` | list of [point](#point), at least 1 |  | optional | More of them. |\n"
            "| `<cable>.pull_N` | number, or `~` | N | optional | A pull. |\n"
            "\n#### point\n\n"
            "A point.\n\n"
            "| key | type and range | unit | default | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `at_m` | `[x, y, z]` | m | required | Where it is. |\n");
}

TEST(KeyReference, PrintsAJsonSchema) {
  EXPECT_EQ(PrintJsonSchema(PointKeys()), R"({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "point",
  "type": "object",
  "description": "A point.",
  "properties": {
    "at_m": {
      "description": "Where it is. Unit: m.",
      "type": "array",
      "items": {
        "type": "number"
      },
      "minItems": 3,
      "maxItems": 3
    }
  },
  "required": ["at_m"],
  "additionalProperties": false
}
)");
}

TEST(KeyReference, TheSchemaHasRangesDefaultsPatternsAndRules) {
  const std::string schema = PrintJsonSchema(BodyKeys());
  EXPECT_THAT(schema, HasSubstr("\"exclusiveMinimum\": 0"));
  EXPECT_THAT(schema, HasSubstr("\"enum\": [\"tet4\", \"tet10\", null]"));
  EXPECT_THAT(schema, HasSubstr("\"default\": \"tet10\""));
  EXPECT_THAT(schema, HasSubstr("\".\\\\.pull_N$\""));
  EXPECT_THAT(schema, HasSubstr("\"oneOf\""));
  EXPECT_THAT(schema, HasSubstr("\"minItems\": 1"));
  EXPECT_THAT(schema, Not(HasSubstr("\"default\": \n")));
}

}  // namespace
}  // namespace palpate::app
