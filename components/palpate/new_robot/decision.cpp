// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/decision.hpp"

namespace palpate::command {

std::string ToString(Trust trust) {
  switch (trust) {
    case Trust::kGiven: return "given";
    case Trust::kNamed: return "named in the mesh";
    case Trust::kLikely: return "likely";
    case Trust::kUnsure: break;
  }
  return "guess";
}

}  // namespace palpate::command
