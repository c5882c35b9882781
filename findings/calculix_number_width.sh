#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    CalculiX 2.20 (Debian 12, calculix-ccx 2.20-1), numbers in an input deck
# Behaviour  ccx reads the first 20 characters of a number and drops the rest without a word. A
#            number of 21 characters or more can lose its exponent, or one digit of it, so that
#            0.0123 is read as 1.23. The run ends with exit code 0. Only where the cut leaves a
#            bare "e-" does ccx report an error, so that 17 digits fail loudly, while 16 digits and
#            19 digits pass with wrong values.
# Expected   The manual says that the data follow no fixed format and are separated by commas: all
#            characters up to the comma count, or the line is refused.
# Matters    "%.18e" is how numpy.savetxt writes by default, and 5.123456789012345e-05 is how
#            Python prints a coordinate in metres: single nodes move to elsewhere in the mesh.
# Needs      apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The program, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install calculix-ccx=2.20-1 libspooles2.2=2.2-14 libarpack2=3.8.0-3 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" root; done
libraries=root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$PWD/$libraries:$PWD/$libraries/lapack:$PWD/$libraries/blas
export OMP_NUM_THREADS=1

# One tetrahedron, whose second node has the number as x.
write_input() {
  cat >job.inp <<INP
*NODE, NSET=ALL
1, 0.0, 0.0, 0.0
2, $1, 0.0, 0.0
3, 0.0, 0.01, 0.0
4, 0.0, 0.0, 0.01
*ELEMENT, TYPE=C3D4, ELSET=BODY
1, 1, 2, 3, 4
*MATERIAL, NAME=SILICONE
*ELASTIC
1.0e5, 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE
*BOUNDARY
1, 1, 3
2, 1, 3
3, 1, 3
*STEP
*STATIC
*CLOAD
4, 3, 0.001
*NODE FILE
U
*END STEP
INP
}

# try WRITTEN: prints how many characters the number has, and what ccx makes of it.
try() {
  local status=0 x
  write_input "$1"
  rm -f job.frd
  root/usr/bin/ccx -i job >log 2>&1 || status=$?
  if ((status == 0)); then
    x=$(awk '$1 == "2C" { nodes = 1 } nodes && $1 == "-1" && $2 == 2 { print $3; exit }' job.frd)
  else
    x=$(grep -o -m 1 'ERROR reading \*NODE' log)
  fi
  printf '%-25s %2d characters: exit %3d, x = %s\n' "$1" "${#1}" "$status" "$x"
}

{
  root/usr/bin/ccx -v | grep -o 'Version.*' || true
  try 1.2345678901235e-02        # %.13e
  try 1.23456789012346e-02       # %.14e
  try 1.234567890123457e-02      # %.15e
  try 1.2345678901234568e-02     # %.16e
  try 1.234567890123456843e-02   # %.18e
  try 5.123456789012345e-05      # repr() of Python
  try 0.012345678901234568       # the same as %.16e, without an exponent
} | tee seen

cat >expected <<'SEEN'
Version 2.20
1.2345678901235e-02       19 characters: exit   0, x = 1.23457E-02
1.23456789012346e-02      20 characters: exit   0, x = 1.23457E-02
1.234567890123457e-02     21 characters: exit   0, x = 1.23457E+00
1.2345678901234568e-02    22 characters: exit 201, x = ERROR reading *NODE
1.234567890123456843e-02  24 characters: exit   0, x = 1.23457E+00
5.123456789012345e-05     21 characters: exit   0, x = 5.12346E+00
0.012345678901234568      20 characters: exit   0, x = 1.23457E-02
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
