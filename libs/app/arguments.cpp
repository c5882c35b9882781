// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/arguments.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>

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

void Require(CLI::Option* option, Need need) { option->required(need == Need::kRequired); }

}  // namespace

std::vector<std::string> CommandLineWords(int argc, const char* const* argv) {
  return {argv + std::min(argc, 1), argv + argc};
}

struct Arguments::Impl {
  Impl(const std::string& program, const std::string& purpose) : cli(purpose, program) {
    cli.set_help_flag("--help,-h", "Print this and exit");
    cli.set_version_flag("--version", program + " " + Version(), "Print the version and exit");
    cli.get_formatter()->column_width(34);
  }

  [[noreturn]] void Refuse(const std::string& message) const {
    throw InputError(message + "; see " + cli.get_name() + " --help");
  }

  /// The options as they are written, for "did you mean".
  std::vector<std::string> OptionNames() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : cli.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
  }

  /// An option that nobody declared is the likeliest cause of whatever else went wrong (a required
  /// one misspelt), so that it is named first.
  void RefuseUnknownOption() const {
    for (const std::string& word : cli.remaining()) {
      if (!word.starts_with("-")) continue;
      const std::string name = word.substr(0, word.find('='));
      Refuse("unknown option '" + name + "'" + DidYouMean(name, OptionNames()));
    }
  }

  CLI::App cli;
};

Arguments::Arguments(const std::string& program, const std::string& purpose)
    : impl_(std::make_unique<Impl>(program, purpose)) {}

Arguments::~Arguments() = default;

void Arguments::Positional(const std::string& name, std::filesystem::path* value,
                           const std::string& help, Need need) {
  const auto assign = [value](const std::string& text) { *value = text; };
  Require(impl_->cli.add_option_function<std::string>(name, assign, help), need);
}

void Arguments::Positional(const std::string& name, std::string* value, const std::string& help,
                           Need need) {
  const auto assign = [value](const std::string& text) { *value = text; };
  Require(impl_->cli.add_option_function<std::string>(name, assign, help), need);
}

void Arguments::Positionals(const std::string& name, std::vector<std::string>* values,
                            const std::string& help, Need need) {
  const auto assign = [values](const std::vector<std::string>& texts) { *values = texts; };
  Require(impl_->cli.add_option_function<std::vector<std::string>>(name, assign, help), need);
}

void Arguments::Option(const std::string& name, std::filesystem::path* value,
                       const std::string& help, Need need) {
  const auto assign = [value](const std::string& text) { *value = text; };
  CLI::Option* option = impl_->cli.add_option_function<std::string>(name, assign, help);
  Require(option->type_name("PATH"), need);
}

void Arguments::Option(const std::string& name, std::string* value, const std::string& help,
                       Need need) {
  const auto assign = [value](const std::string& text) { *value = text; };
  Require(impl_->cli.add_option_function<std::string>(name, assign, help), need);
}

void Arguments::Option(const std::string& name, int* value, int min, int max,
                       const std::string& help, Need need) {
  const auto check = [min, max](const std::string& text) {
    int number = 0;
    if (ParseWhole(text, &number) && number >= min && number <= max) return std::string();
    return "must be a whole number from " + std::to_string(min) + " to " + std::to_string(max) +
           ", not '" + text + "'";
  };
  const auto assign = [value](const std::string& text) { ParseWhole(text, value); };
  CLI::Option* option = impl_->cli.add_option_function<std::string>(name, assign, help);
  Require(option->type_name("N")->check(check), need);
}

void Arguments::Option(const std::string& name, double* value, const std::string& help, Need need) {
  const auto assign = [value](const std::string& text) { ParseFinite(text, value); };
  CLI::Option* option = impl_->cli.add_option_function<std::string>(name, assign, help);
  Require(option->type_name("NUMBER")->check(CheckFinite), need);
}

void Arguments::Choice(const std::string& name, std::string* value,
                       std::vector<std::string> choices, const std::string& help, Need need) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : "|") + choice;
  const auto check = [choices = std::move(choices), list](const std::string& text) {
    const bool known = std::find(choices.begin(), choices.end(), text) != choices.end();
    return known ? std::string()
                 : "must be " + list + ", not '" + text + "'" + DidYouMean(text, choices);
  };
  const auto assign = [value](const std::string& text) { *value = text; };
  CLI::Option* option = impl_->cli.add_option_function<std::string>(name, assign, help);
  Require(option->type_name(list)->check(check), need);
}

void Arguments::Repeated(const std::string& name, std::vector<std::string>* values,
                         const std::string& help) {
  const auto assign = [values](const std::vector<std::string>& texts) { *values = texts; };
  impl_->cli.add_option_function<std::vector<std::string>>(name, assign, help)
      ->type_name("TEXT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void Arguments::Flag(const std::string& name, bool* value, const std::string& help) {
  impl_->cli.add_flag(name, *value, help);
}

bool Arguments::WasGiven(const std::string& name) const { return impl_->cli.count(name) > 0; }

bool Arguments::Parse(const std::vector<std::string>& words) {
  try {
    impl_->cli.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    std::fputs(Help().c_str(), stdout);
    return false;
  } catch (const CLI::CallForVersion& version) {
    std::printf("%s\n", version.what());
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

std::string Arguments::Help() const { return impl_->cli.help(); }

}  // namespace palpate::app
