// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::command {

/// How well a value of a new robot file is founded.
enum class Trust {
  kGiven,   ///< by an option or an answer
  kNamed,   ///< by the mesh file
  kLikely,  ///< from the shape, with a margin
  kUnsure,  ///< could as well be another one
};

/// "given", "named in the mesh", "likely", "guess".
std::string ToString(Trust trust);

/// A value of a new robot file, with its reason.
struct Decision {
  std::string what;   ///< "unit"
  std::string value;  ///< as people read it
  Trust trust = Trust::kUnsure;
  std::string why;          ///< a clause without its full stop
  std::string option = {};  ///< that changes it
};

}  // namespace palpate::command
