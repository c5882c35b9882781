// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::diagnosis {

/// The style sheet of the report: light, for the screen and for pages of A4.
extern const char* const kReportStyle;

}  // namespace palpate::diagnosis
