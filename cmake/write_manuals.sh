#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# write_manuals.sh SHARE PROGRAM...: asks the programs of the current folder for their manual pages
# and completions, and writes them where man and bash-completion expect them below SHARE. The first
# program has verbs; each of these gets a page of its own, palpate-VERB or, where a program has that
# name, palpate_VERB. Verbs of verbs get palpate-VERB-VERB.
set -euo pipefail

readonly share=$1
shift
readonly pages=$share/man/man1 completions=$share/bash-completion/completions
mkdir -p "$pages" "$completions"

for program in "$@"; do
  "./$program" --man >"$pages/$program.1"
  "./$program" --completion bash >"$completions/$program"
done

# The verbs, as the completion offers them.
source "$completions/$1"
COMP_WORDS=("$1" '')
COMP_CWORD=1
"_$1"
for verb in "${COMPREPLY[@]}"; do
  page=$pages/$1-$verb.1
  [[ " $* " != *" $1-$verb "* ]] || page=$pages/$1_$verb.1
  "./$1" "$verb" --man >"$page"
  grep -q '^\.SH VERBS' "$page" || continue
  COMP_WORDS=("$1" "$verb" '')
  COMP_CWORD=2
  "_$1"
  for below in "${COMPREPLY[@]}"; do
    "./$1" "$verb" "$below" --man >"$pages/$1-$verb-$below.1"
  done
done
