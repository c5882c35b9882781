// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/launch/launcher.hpp"
#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// The system file that `system` names: a path, or the name of one in config/systems. Throws
/// InputError where neither is there, with "did you mean".
std::filesystem::path FindSystemFile(const std::filesystem::path& system);

/// The names of the system files in config/systems.
std::vector<std::string> KnownSystems();

/// The host of that name. Empty: the only one, or the one that this computer is, by its name or
/// its addresses. Throws InputError where there is none.
HostPlan& ChooseHost(SystemFile& system, const std::string& name);

/// What is executed for each process of the host, in the order of the file. Throws InputError for a
/// program, a settings file or a configuration that is not there.
std::vector<LaunchedProcess> MakeLaunchPlan(const SystemFile& system, const HostPlan& host);

/// "PROCESS.KEY=VALUE": adds a setting to a process of the host. Throws InputError.
void ApplySet(const std::string& assignment, HostPlan* host);

/// The command as a shell takes it, without the environment.
std::string ShellLine(const ChildCommand& command);
/// In single quotes where a shell needs them.
std::string ShellWord(const std::string& word);

}  // namespace palpate::command
