#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Ipopt 3.11.9 (Debian 12, coinor-libipopt1v5), bound multipliers of fixed variables
# Behaviour  A variable whose bounds are equal is taken out of the problem, which is the default.
#            Ipopt returns z_L = z_U = 0 for it, with success. Bounds that differ by 1e-6
#            give the multiplier 4. So does fixed_variable_treatment=make_constraint.
# Expected   At a solution the gradient of the objective equals z_L - z_U, here -4. The option says
#            that the variable is removed, and nothing of its multipliers.
# Matters    A multiplier of a bound is a force: of a cable held at its length, or of a contact. It
#            vanishes when the two bounds meet. Sensitivities lose the parameters held fixed.
# Needs      gcc, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The library, and what it depends on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install coinor-libipopt1v5=3.11.9-2.3+b1 coinor-libipopt-dev=3.11.9-2.3+b1 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
search=$libraries:$libraries/lapack:$libraries/blas
export OMP_NUM_THREADS=1

# Minimise (x - 3)^2 + (y - 1)^2 with x in [lower, 1].
cat >solve.c <<'C'
#include <stddef.h>
#include <stdio.h>

#include <IpStdCInterface.h>

static Bool Objective(Index n, Number* x, Bool is_new, Number* value, UserDataPtr data) {
  (void)n, (void)is_new, (void)data;
  *value = (x[0] - 3) * (x[0] - 3) + (x[1] - 1) * (x[1] - 1);
  return TRUE;
}

static Bool Gradient(Index n, Number* x, Bool is_new, Number* value, UserDataPtr data) {
  (void)n, (void)is_new, (void)data;
  value[0] = 2 * (x[0] - 3);
  value[1] = 2 * (x[1] - 1);
  return TRUE;
}

static Bool Constraints(Index n, Number* x, Bool is_new, Index m, Number* value,
                        UserDataPtr data) {
  (void)n, (void)is_new, (void)m, (void)data;
  value[0] = x[0] + x[1];
  return TRUE;
}

static Bool Jacobian(Index n, Number* x, Bool is_new, Index m, Index size, Index* rows,
                     Index* columns, Number* values, UserDataPtr data) {
  (void)n, (void)x, (void)is_new, (void)m, (void)data;
  for (Index k = 0; k < size; ++k) {
    if (values != NULL) {
      values[k] = 1;
    } else {
      rows[k] = 0;
      columns[k] = k;
    }
  }
  return TRUE;
}

static Bool Hessian(Index n, Number* x, Bool is_new, Number factor, Index m, Number* lambda,
                    Bool is_new_lambda, Index size, Index* rows, Index* columns, Number* values,
                    UserDataPtr data) {
  (void)n, (void)x, (void)is_new, (void)m, (void)lambda, (void)is_new_lambda, (void)data;
  for (Index k = 0; k < size; ++k) {
    if (values != NULL) {
      values[k] = 2 * factor;
    } else {
      rows[k] = columns[k] = k;
    }
  }
  return TRUE;
}

static void Solve(double lower, char* treatment) {
  Number x_lower[2] = {lower, -10}, x_upper[2] = {1, 10};
  Number g_lower[1] = {-100}, g_upper[1] = {100};
  Number x[2] = {0.5, 0.5}, z_lower[2], z_upper[2];
  IpoptProblem problem = CreateIpoptProblem(2, x_lower, x_upper, 1, g_lower, g_upper, 2, 2, 0,
                                            Objective, Constraints, Gradient, Jacobian, Hessian);
  AddIpoptIntOption(problem, "print_level", 0);
  AddIpoptStrOption(problem, "sb", "yes");
  if (treatment != NULL) AddIpoptStrOption(problem, "fixed_variable_treatment", treatment);
  const int status = IpoptSolve(problem, x, NULL, NULL, NULL, z_lower, z_upper, NULL);
  printf("x in [%8.6f, 1], %-15s: status %d, x = %.4f, z_U - z_L = %.2f\n", lower,
         treatment == NULL ? "default" : treatment, status, x[0], z_upper[0] - z_lower[0]);
  FreeIpoptProblem(problem);
}

int main(void) {
  Solve(0, NULL);
  Solve(1 - 1e-6, NULL);
  Solve(1, NULL);
  Solve(1, "make_constraint");
  return 0;
}
C
gcc -O1 -isystem unpacked/usr/include/coin solve.c -o solve -L"$libraries" \
  -Wl,-rpath-link,"$search" -l:libipopt.so.1 -lm

{
  dpkg-deb -f debs/coinor-libipopt1v5_*.deb Version
  LD_LIBRARY_PATH=$search ./solve
} | tee seen

cat >expected <<'SEEN'
3.11.9-2.3+b1
x in [0.000000, 1], default        : status 0, x = 1.0000, z_U - z_L = 4.00
x in [0.999999, 1], default        : status 0, x = 1.0000, z_U - z_L = 4.00
x in [1.000000, 1], default        : status 0, x = 1.0000, z_U - z_L = 0.00
x in [1.000000, 1], make_constraint: status 0, x = 1.0000, z_U - z_L = 4.00
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
