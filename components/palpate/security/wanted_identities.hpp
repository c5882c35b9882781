// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/palpate/security/manifest.hpp"
#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// "NAME[=ROLE][@HOST]" as people write it: "capture@camera_host", "left_capture=capture". Without
/// a role the name is one. Throws InputError for an empty part.
Identity ParseIdentity(const std::string& text);

/// The identities of a system file: one for each process of a component, named after the component,
/// or by its setting dds.identity; with the namespace and remapping of the process. Throws
/// InputError at the place of two processes with one name.
std::vector<Identity> IdentitiesOfSystem(const SystemFile& system);

}  // namespace palpate::command
