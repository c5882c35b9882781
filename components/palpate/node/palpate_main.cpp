// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/verbs.hpp"
#include "libs/app/arguments.hpp"
#include "libs/app/run_main.hpp"

int main(int argc, char** argv) {
  return palpate::app::RunMain("palpate", [&] {
    return palpate::command::RunCommand(palpate::app::CommandLineWords(argc, argv));
  });
}
