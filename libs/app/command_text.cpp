// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/command_text.hpp"

#include <cctype>
#include <sstream>

#include "libs/app/version.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kPageWidth = 80;
constexpr std::size_t kTextColumn = 26;

/// "--out FOLDER"
std::string Left(const ArgumentText& argument) {
  return argument.name + (argument.value.empty() ? "" : " " + argument.value);
}

/// Appends the words of `text` to `line` and that to the page; further lines begin at `column`.
void AppendWrapped(std::string line, std::size_t column, const std::string& text,
                   std::string* page) {
  std::istringstream words(text);
  bool begins_line = line.size() <= column;
  for (std::string word; words >> word;) {
    if (!begins_line && line.size() + 1 + word.size() > kPageWidth) {
      *page += line + "\n";
      line.assign(column, ' ');
      begins_line = true;
    }
    line += (begins_line ? "" : " ") + word;
    begins_line = false;
  }
  *page += line + "\n";
}

/// Appends an item of a list: `left`, then `text` from kTextColumn on.
void AppendItem(const std::string& left, const std::string& text, std::string* page) {
  std::string line = "  " + left;
  if (line.size() + 2 > kTextColumn) {
    *page += line + "\n";
    line.clear();
  }
  line.resize(kTextColumn, ' ');
  AppendWrapped(line, kTextColumn, text, page);
}

bool HasPositionals(const CommandText& command) {
  for (const ArgumentText& argument : command.arguments) {
    if (!argument.IsOption()) return true;
  }
  return false;
}

/// What follows the name: "ROBOT --out FOLDER [OPTIONS]".
std::string Synopsis(const CommandText& command) {
  if (!command.verbs.empty()) return "VERB [ARGUMENTS]";
  std::string synopsis;
  for (const ArgumentText& argument : command.arguments) {
    if (!argument.IsOption()) {
      synopsis += (argument.is_required ? argument.name : "[" + argument.name + "]") + " ";
    } else if (argument.is_required) {
      synopsis += Left(argument) + " ";
    }
  }
  return synopsis + "[OPTIONS]";
}

/// "palpate-solve": the name of the manual page.
std::string PageName(std::string command) {
  for (char& c : command) {
    if (c == ' ') c = '-';
  }
  return command;
}

/// `text` as roff prints it literally.
std::string Roff(const std::string& text) {
  std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '-') {
      escaped += "\\-";
    } else if (c == '\\') {
      escaped += "\\e";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

void AppendRoffItem(const std::string& name, const std::string& value, const std::string& text,
                    std::string* page) {
  *page += ".TP\n\\fB" + Roff(name) + "\\fR" +
           (value.empty() ? "" : " \\fI" + Roff(value) + "\\fR") + "\n" + Roff(text) + "\n";
}

void AppendRoffArguments(const CommandText& command, std::string* page) {
  if (HasPositionals(command)) *page += ".SH ARGUMENTS\n";
  for (const ArgumentText& argument : command.arguments) {
    if (!argument.IsOption()) AppendRoffItem(argument.name, "", argument.help, page);
  }
  *page += ".SH OPTIONS\n";
  for (const ArgumentText& argument : command.arguments) {
    if (argument.IsOption()) AppendRoffItem(argument.name, argument.value, argument.help, page);
  }
}

void AppendSeeAlso(const CommandText& command, std::string* page) {
  const std::size_t space = command.name.find(' ');
  std::string pages;
  if (space != std::string::npos) pages = "\\fB" + command.name.substr(0, space) + "\\fR(1)";
  for (const VerbText& verb : command.verbs) {
    pages +=
        (pages.empty() ? "\\fB" : ",\n\\fB") + Roff(command.name + "-" + verb.name) + "\\fR(1)";
  }
  if (!pages.empty()) *page += ".SH SEE ALSO\n" + pages + "\n";
}

}  // namespace

std::vector<ArgumentText> CommonArguments(const std::string& command, bool is_verb) {
  std::vector<ArgumentText> arguments = {
      {.name = "--help", .help = "Print this and exit (also -h)"},
      {.name = "--version", .help = "Print the version and exit"},
      {.name = "--man",
       .help = "Print the manual page and exit; to read it: " + command + " --man | man -l -"}};
  if (is_verb) return arguments;
  arguments.push_back({.name = "--completion",
                       .value = "bash",
                       .help = "Print the completion script of the shell and exit; to use it: "
                               "source <(" +
                               command + " --completion bash)",
                       .words = {"bash"}});
  return arguments;
}

std::string FormatHelp(const CommandText& command) {
  std::string page;
  AppendWrapped("", 0, command.purpose, &page);
  page += "\n";
  AppendWrapped("Usage: " + command.name, std::string("Usage: ").size(), Synopsis(command), &page);
  if (!command.verbs.empty()) page += "\nVerbs:\n";
  for (const VerbText& verb : command.verbs) AppendItem(verb.name, verb.purpose, &page);
  if (HasPositionals(command)) page += "\nArguments:\n";
  for (const ArgumentText& argument : command.arguments) {
    if (!argument.IsOption()) AppendItem(argument.name, argument.help, &page);
  }
  page += "\nOptions:\n";
  for (const ArgumentText& argument : command.arguments) {
    if (argument.IsOption()) AppendItem(Left(argument), argument.help, &page);
  }
  if (!command.verbs.empty()) {
    page += "\n" + command.name + " VERB --help lists the arguments of a verb.\n";
  }
  return page;
}

std::string FormatManualPage(const CommandText& command) {
  const std::string name = PageName(command.name);
  std::string title = name;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string page = ".TH \"" + Roff(title) + "\" 1 \"\" \"palpate " + Version() +
                     "\" \"User Commands\"\n.SH NAME\n" + Roff(name) + " \\- " +
                     Roff(command.purpose) + "\n.SH SYNOPSIS\n\\fB" + Roff(command.name) + "\\fR " +
                     Roff(Synopsis(command)) + "\n";
  if (!command.verbs.empty()) page += ".SH VERBS\n";
  for (const VerbText& verb : command.verbs) AppendRoffItem(verb.name, "", verb.purpose, &page);
  AppendRoffArguments(command, &page);
  page +=
      ".SH EXIT STATUS\n0: done; 1: failed while running; 2: wrong usage, settings or input "
      "files; 130: interrupted by a signal.\n";
  AppendSeeAlso(command, &page);
  return page;
}

}  // namespace palpate::app
