// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::command {

/// Makes room in `folder` for the results of a `solve` that may write `planned` names: removes the
/// files that the result.json of an earlier `solve` lists under "files", so that no old row is
/// mistaken for a new one. Other files stay. Throws InputError, and removes nothing, where one of
/// `planned` is there that no earlier `solve` wrote. A folder that is not there has room.
void MakeRoomForResults(const std::filesystem::path& folder,
                        const std::vector<std::string>& planned);

}  // namespace palpate::command
