// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

#include "components/view/serve/web_server.hpp"

namespace palpate::view {

/// A file of the page, as it was when this program was built.
struct PageFile {
  std::string_view path;  ///< "/app.js"
  std::string_view gzip;
};

/// The file of a path, "/" being "/index.html"; 404 for all others. Only whole names of files of
/// the page are known, so no path leads out of it.
HttpAnswer AnswerPageFile(std::string_view path);

}  // namespace palpate::view
