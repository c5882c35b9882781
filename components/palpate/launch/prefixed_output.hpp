// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "components/palpate/launch/launcher.hpp"

namespace palpate::command {

/// Writes "[process] line". With colour, each process has one of its own.
class PrefixedOutput : public LaunchOutput {
 public:
  /// `names`: of all processes, for the width of the prefix. `file` must outlive this object.
  PrefixedOutput(const std::vector<std::string>& names, std::FILE* file, bool with_colour);

  void Line(const std::string& process, std::string_view line) override;
  void Event(const std::string& process, Severity severity, const std::string& text) override;

 private:
  void Write(const std::string& name, const std::string& colour, std::string_view text);

  std::FILE* file_;
  bool with_colour_;
  std::size_t width_;
  std::map<std::string, std::string> colours_;
};

/// The closing table of a launch: process, end, restarts, run time, peak memory.
std::string ReportText(const std::vector<ProcessReport>& reports);
/// The same as a JSON object.
std::string ReportJson(const std::string& system, const std::string& host, int exit_code,
                       const std::vector<ProcessReport>& reports);

}  // namespace palpate::command
