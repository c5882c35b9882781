// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/recorder/recording_file.hpp"

namespace palpate::recorder {

/// A file as an attachment, under its name without folders. Throws InputError where it cannot be
/// read.
recording::Attachment AttachmentOf(const std::filesystem::path& file);

/// A text as an attachment.
recording::Attachment AttachmentOf(const std::string& name, std::string text);

/// The robot file and the mesh that it names. Throws InputError where one cannot be read.
std::vector<recording::Attachment> AttachRobot(const std::filesystem::path& robot_file);

}  // namespace palpate::recorder
