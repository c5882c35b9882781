// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <string>

namespace palpate::capture {

/// The text inside an element of a GenICam description, without blanks at its ends.
std::string TextOf(ArvDomNode* element);

}  // namespace palpate::capture
