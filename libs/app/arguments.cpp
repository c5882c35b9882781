// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/arguments.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

/// CLI11 reads numbers with strtod, which takes "nan", "0x1p3" and the locale's comma. These
/// transformers leave the text alone and only check it; the callbacks below convert.
std::string CheckFinite(const std::string& text) {
  double value = 0.0;
  return ParseFinite(text, &value) ? "" : "must be a finite number, not '" + text + "'";
}

bool ParseWhole(const std::string& text, int* value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

/// What --help and its like print; thrown through the parser, which then asks for nothing more.
struct Answer {
  std::string text;
};

/// "from 1 to 64", or "0 or more".
std::string Range(int min, int max) {
  if (max == std::numeric_limits<int>::max()) return std::to_string(min) + " or more";
  return "from " + std::to_string(min) + " to " + std::to_string(max);
}

/// `help` with what else is known of the option, such as "[from 1 to 64; default: 2]".
std::string WithNotes(const std::string& help, const std::vector<std::string>& notes) {
  std::string list;
  for (const std::string& note : notes) {
    if (!note.empty()) list += (list.empty() ? "" : "; ") + note;
  }
  return list.empty() ? help : help + " [" + list + "]";
}

std::string NoteOnNeed(Need need) { return need == Need::kRequired ? "required" : ""; }

/// A required argument has no default, whatever its target holds.
std::string NoteOnDefault(Need need, const std::string& value) {
  return value.empty() || need == Need::kRequired ? "" : "default: " + value;
}

/// The same of an option, of which `help` may say what holds without it.
std::string NoteOnDefault(Need need, const std::string& value, const std::string& help) {
  const bool is_none = value.empty() && need == Need::kOptional;
  if (is_none && help.find("without it") == std::string::npos) return "default: none";
  return NoteOnDefault(need, value);
}

/// "--out FOLDER" -> "--out", "FOLDER"; "--window,-w N" has a short name, too. Without a second
/// word `placeholder`.
ArgumentText OptionText(const std::string& declared, const std::string& placeholder) {
  const std::size_t space = declared.find(' ');
  ArgumentText text;
  text.name = declared.substr(0, space);
  text.value = space == std::string::npos ? placeholder : declared.substr(space + 1);
  if (const std::size_t comma = text.name.find(','); comma != std::string::npos) {
    text.short_name = text.name.substr(comma + 1);
    text.name.resize(comma);
  }
  return text;
}

std::string NoteOnShortName(const ArgumentText& argument) {
  return argument.short_name.empty() ? "" : " (also " + argument.short_name + ")";
}

/// As CLI11 takes it.
std::string AllNames(const ArgumentText& argument) {
  return argument.name + (argument.short_name.empty() ? "" : "," + argument.short_name);
}

}  // namespace

std::vector<std::string> CommandLineWords(int argc, const char* const* argv) {
  return {argv + std::min(argc, 1), argv + argc};
}

struct Arguments::Impl {
  Impl(const std::string& program, const std::string& purpose, Scope scope)
      : cli(purpose, program), text{.name = program, .purpose = purpose} {
    cli.set_help_flag();
    cli.add_flag_callback("--help,-h", [this] { throw Answer{FormatHelp(Text())}; });
    cli.add_flag_callback("--version", [program] { throw Answer{VersionLine(program)}; });
    cli.add_flag_callback("--man", [this] { throw Answer{FormatManualPage(Text())}; });
    common = CommonArguments(program, scope == Scope::kVerb);
    if (scope == Scope::kVerb) return;
    const auto complete = [this](const std::string& shell) {
      if (shell != "bash") Refuse("--completion: must be bash, not '" + shell + "'");
      throw Answer{FormatBashCompletion(Text(), {})};
    };
    cli.add_option_function<std::string>("--completion", complete, "");
  }

  [[noreturn]] void Refuse(const std::string& message) const {
    throw InputError(message + "; see " + cli.get_name() + " --help");
  }

  CommandText Text() const {
    CommandText sorted = text;
    std::stable_partition(sorted.arguments.begin(), sorted.arguments.end(),
                          [](const ArgumentText& argument) { return !argument.IsOption(); });
    sorted.arguments.insert(sorted.arguments.end(), common.begin(), common.end());
    return sorted;
  }

  /// Declares an argument with one value, to be taken by `assign`.
  CLI::Option* Add(const ArgumentText& argument, Need need,
                   std::function<void(const std::string&)> assign) {
    text.arguments.push_back(argument);
    text.arguments.back().help += NoteOnShortName(argument);
    text.arguments.back().is_required = need == Need::kRequired;
    return cli.add_option_function<std::string>(AllNames(argument), std::move(assign))
        ->required(need == Need::kRequired);
  }

  CLI::Option* AddMany(const ArgumentText& argument, Need need, std::vector<std::string>* values) {
    text.arguments.push_back(argument);
    text.arguments.back().is_required = need == Need::kRequired;
    const auto assign = [values](const std::vector<std::string>& texts) { *values = texts; };
    return cli.add_option_function<std::vector<std::string>>(argument.name, assign)
        ->required(need == Need::kRequired);
  }

  /// The options as they are written, for "did you mean".
  std::vector<std::string> OptionNames() const {
    std::vector<std::string> names;
    for (const ArgumentText& argument : Text().arguments) {
      if (argument.IsOption()) names.push_back(argument.name);
    }
    return names;
  }

  /// An unknown option is the likeliest cause of any other error (a required one misspelt), so it
  /// is named first.
  void RefuseUnknownOption() const {
    for (const std::string& word : cli.remaining()) {
      if (!word.starts_with("-")) continue;
      const std::string name = word.substr(0, word.find('='));
      Refuse("unknown option '" + name + "'" + DidYouMean(name, OptionNames()));
    }
  }

  CLI::App cli;
  CommandText text;  ///< in the order of declaration, without what is common
  std::vector<ArgumentText> common;
};

Arguments::Arguments(const std::string& program, const std::string& purpose, Scope scope)
    : impl_(std::make_unique<Impl>(program, purpose, scope)) {}

Arguments::~Arguments() = default;

void Arguments::Positional(const std::string& name, std::filesystem::path* value,
                           const std::string& help, Need need) {
  impl_->Add({.name = name,
              .help = WithNotes(help, {NoteOnDefault(need, value->string())}),
              .is_path = true},
             need, [value](const std::string& text) { *value = text; });
}

void Arguments::Positional(const std::string& name, std::string* value, const std::string& help,
                           Need need) {
  impl_->Add({.name = name, .help = WithNotes(help, {NoteOnDefault(need, *value)})}, need,
             [value](const std::string& text) { *value = text; });
}

void Arguments::Positionals(const std::string& name, std::vector<std::string>* values,
                            const std::string& help, Need need) {
  impl_->AddMany({.name = name, .help = WithNotes(help, {"any number"})}, need, values);
}

void Arguments::Option(const std::string& name, std::filesystem::path* value,
                       const std::string& help, Need need) {
  ArgumentText argument = OptionText(name, "FILE");
  argument.help = WithNotes(help, {NoteOnNeed(need), NoteOnDefault(need, value->string(), help)});
  argument.is_path = true;
  impl_->Add(argument, need, [value](const std::string& text) { *value = text; });
}

void Arguments::Option(const std::string& name, std::string* value, const std::string& help,
                       Need need) {
  ArgumentText argument = OptionText(name, "TEXT");
  argument.help = WithNotes(help, {NoteOnNeed(need), NoteOnDefault(need, *value, help)});
  impl_->Add(argument, need, [value](const std::string& text) { *value = text; });
}

void Arguments::Option(const std::string& name, int* value, int min, int max,
                       const std::string& help, Need need) {
  const bool has_default = *value >= min && *value <= max;
  ArgumentText argument = OptionText(name, "N");
  argument.help =
      WithNotes(help, {NoteOnNeed(need), Range(min, max),
                       NoteOnDefault(need, has_default ? std::to_string(*value) : "", help)});
  const auto check = [min, max](const std::string& text) {
    int number = 0;
    if (ParseWhole(text, &number) && number >= min && number <= max) return std::string();
    return "must be a whole number, " + Range(min, max) + ", not '" + text + "'";
  };
  impl_->Add(argument, need, [value](const std::string& text) { ParseWhole(text, value); })
      ->check(check);
}

void Arguments::Option(const std::string& name, double* value, const std::string& help, Need need) {
  ArgumentText argument = OptionText(name, "NUMBER");
  argument.help = WithNotes(
      help, {NoteOnNeed(need),
             NoteOnDefault(need, std::isfinite(*value) ? FormatNumber(*value) : "", help)});
  impl_->Add(argument, need, [value](const std::string& text) { ParseFinite(text, value); })
      ->check(CheckFinite);
}

void Arguments::Choice(const std::string& name, std::string* value,
                       std::vector<std::string> choices, const std::string& help, Need need) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : "|") + choice;
  ArgumentText argument = OptionText(name, list);
  argument.help = WithNotes(help, {NoteOnNeed(need), NoteOnDefault(need, *value, help)});
  argument.words = choices;
  const auto check = [choices = std::move(choices), list](const std::string& text) {
    const bool known = std::find(choices.begin(), choices.end(), text) != choices.end();
    return known ? std::string()
                 : "must be " + list + ", not '" + text + "'" + DidYouMean(text, choices);
  };
  impl_->Add(argument, need, [value](const std::string& text) { *value = text; })->check(check);
}

void Arguments::Repeated(const std::string& name, std::vector<std::string>* values,
                         const std::string& help) {
  ArgumentText argument = OptionText(name, "TEXT");
  argument.help = WithNotes(help, {"may be repeated"});
  // Left to itself CLI11 gives all words up to the next option to one that takes a list.
  impl_->AddMany(argument, Need::kOptional, values)
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void Arguments::Flag(const std::string& name, bool* value, const std::string& help) {
  ArgumentText argument = OptionText(name, "");
  argument.help = help + NoteOnShortName(argument);
  impl_->text.arguments.push_back(argument);
  impl_->cli.add_flag(AllNames(argument), *value);
}

void Arguments::Suggest(const std::string& name, std::vector<std::string> words) {
  for (ArgumentText& argument : impl_->text.arguments) {
    if (argument.name == name) argument.words = std::move(words);
  }
}

bool Arguments::WasGiven(const std::string& name) const { return impl_->cli.count(name) > 0; }

bool Arguments::Parse(const std::vector<std::string>& words) {
  try {
    impl_->cli.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const Answer& answer) {
    std::fputs(answer.text.c_str(), stdout);
    return false;
  } catch (const CLI::ParseError& error) {
    impl_->RefuseUnknownOption();
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
      impl_->Refuse("unexpected argument '" + impl_->cli.remaining().front() + "'");
    }
    impl_->Refuse(error.what());
  }
  return true;
}

CommandText Arguments::Text() const { return impl_->Text(); }

}  // namespace palpate::app
