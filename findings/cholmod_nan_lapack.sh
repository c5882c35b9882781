#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    CHOLMOD 3.0.14 of SuiteSparse 5.12.0 (Debian 12, libcholmod3 1:5.12.0+dfsg-2) with the
#            two LAPACK packages that Debian offers for it: OpenBLAS 0.3.21 and the reference 3.11.0
# Behaviour  A matrix with a NaN on its diagonal: whether the supernodal factorisation reports it
#            depends on the LAPACK that is installed. With the reference, the status is
#            CHOLMOD_NOT_POSDEF. With OpenBLAS, which is what Debian chooses where both are
#            installed, the status is CHOLMOD_OK and L->minor is n, as after a success. The
#            simplicial factorisation never reports it. A negative pivot is always reported.
# Expected   The reference dpotrf() tests each pivot for NaN and returns its number in INFO.
#            OpenBLAS replaces it behind the same interface, so one binary reports one status.
# Matters    A NaN stiffness, of an inverted element, gets past "is it positive definite?" on one
#            machine and not on another.
# Needs      gcc, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The libraries, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install libcholmod3=1:5.12.0+dfsg-2 libsuitesparse-dev=1:5.12.0+dfsg-2 \
  libopenblas0-pthread=0.3.21+ds-4 liblapack3=3.11.0-2 libblas3=3.11.0-2 >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
for package in debs/*.deb; do dpkg -x "$package" unpacked; done
libraries=$PWD/unpacked/usr/lib/x86_64-linux-gnu
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

cat >factorise.c <<'C'
#include <math.h>
#include <stdio.h>

#include <cholmod.h>

enum { kSize = 4 };

/* Tridiagonal, 4 on the diagonal but for `third`, 1 beside it. */
static cholmod_sparse* Matrix(double third, cholmod_common* common) {
  cholmod_triplet* entries =
      cholmod_allocate_triplet(kSize, kSize, 2 * kSize - 1, -1, CHOLMOD_REAL, common);
  int* rows = entries->i;
  int* columns = entries->j;
  double* values = entries->x;
  size_t count = 0;
  for (int k = 0; k < kSize; ++k) {
    rows[count] = columns[count] = k;
    values[count++] = k == 2 ? third : 4.0;
    if (k == 0) continue;
    rows[count] = k;
    columns[count] = k - 1;
    values[count++] = 1.0;
  }
  entries->nnz = count;
  cholmod_sparse* matrix = cholmod_triplet_to_sparse(entries, count, common);
  cholmod_free_triplet(&entries, common);
  return matrix;
}

static void Factorise(const char* name, double third, int supernodal) {
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = supernodal;
  common.print = 0;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 0;
  common.final_ll = 1;
  cholmod_sparse* matrix = Matrix(third, &common);
  cholmod_factor* factor = cholmod_analyze(matrix, &common);
  cholmod_factorize(matrix, factor, &common);
  const char* status = common.status == CHOLMOD_OK           ? "CHOLMOD_OK"
                       : common.status == CHOLMOD_NOT_POSDEF ? "CHOLMOD_NOT_POSDEF"
                                                             : "another";
  printf("  %-10s pivot %-3s: %-18s minor %d of %d\n",
         supernodal == CHOLMOD_SUPERNODAL ? "supernodal" : "simplicial", name, status,
         (int)factor->minor, (int)factor->n);
  cholmod_free_factor(&factor, &common);
  cholmod_free_sparse(&matrix, &common);
  cholmod_finish(&common);
}

int main(void) {
  Factorise("4", 4.0, CHOLMOD_SUPERNODAL);
  Factorise("-1", -1.0, CHOLMOD_SUPERNODAL);
  Factorise("NaN", NAN, CHOLMOD_SUPERNODAL);
  Factorise("-1", -1.0, CHOLMOD_SIMPLICIAL);
  Factorise("NaN", NAN, CHOLMOD_SIMPLICIAL);
  return 0;
}
C
gcc -O1 -isystem unpacked/usr/include/suitesparse factorise.c -o factorise \
  -L"$libraries" -Wl,-rpath-link,"$libraries:$libraries/lapack:$libraries/blas" \
  -l:libcholmod.so.3 -lm

{
  dpkg-deb -f debs/libcholmod3_*.deb Version
  echo "liblapack3 (reference)"
  LD_LIBRARY_PATH=$libraries/lapack:$libraries/blas:$libraries ./factorise
  echo "libopenblas0-pthread"
  LD_LIBRARY_PATH=$libraries/openblas-pthread:$libraries ./factorise
} | tee seen

cat >expected <<'SEEN'
1:5.12.0+dfsg-2
liblapack3 (reference)
  supernodal pivot 4  : CHOLMOD_OK         minor 4 of 4
  supernodal pivot -1 : CHOLMOD_NOT_POSDEF minor 2 of 4
  supernodal pivot NaN: CHOLMOD_NOT_POSDEF minor 2 of 4
  simplicial pivot -1 : CHOLMOD_NOT_POSDEF minor 2 of 4
  simplicial pivot NaN: CHOLMOD_OK         minor 4 of 4
libopenblas0-pthread
  supernodal pivot 4  : CHOLMOD_OK         minor 4 of 4
  supernodal pivot -1 : CHOLMOD_NOT_POSDEF minor 2 of 4
  supernodal pivot NaN: CHOLMOD_OK         minor 4 of 4
  simplicial pivot -1 : CHOLMOD_NOT_POSDEF minor 2 of 4
  simplicial pivot NaN: CHOLMOD_OK         minor 4 of 4
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
