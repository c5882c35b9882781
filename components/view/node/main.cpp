// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/command_line.hpp"
#include "libs/app/run_node.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunNode("palpate-view", view::ReadCommand, view::MakeNode, argc, argv);
}
