// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/command_line.hpp"
#include "libs/app/run_node.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunNode("palpate-virtual-robot", virtual_robot::ReadCommand, virtual_robot::MakeNode,
                      argc, argv);
}
