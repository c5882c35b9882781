// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/heap_counter.hpp"

#include <dlfcn.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PALPATE_COUNTS_HEAP_REQUESTS 1
#endif

namespace palpate::test_support {

namespace {

std::atomic<size_t> heap_requests = 0;

#if defined(PALPATE_COUNTS_HEAP_REQUESTS)
void CountRequestFrom(void* caller) {
  Dl_info library{};
  const bool known = dladdr(caller, &library) != 0 && library.dli_fname != nullptr;
  if (known && std::strstr(library.dli_fname, "libopenblas") != nullptr) return;
  if (known && std::strstr(library.dli_fname, "libgomp") != nullptr) return;
  ++heap_requests;
}
#endif

}  // namespace

size_t HeapRequestCount() { return heap_requests; }

bool HeapRequestsAreCounted() {
#if defined(PALPATE_COUNTS_HEAP_REQUESTS)
  return true;
#else
  return false;
#endif
}

}  // namespace palpate::test_support

#if defined(PALPATE_COUNTS_HEAP_REQUESTS)
// glibc's own names of the functions that take the place of malloc and its kin here. operator new
// calls malloc.
extern "C" {

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* pointer, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) {
  palpate::test_support::CountRequestFrom(__builtin_return_address(0));
  return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
  palpate::test_support::CountRequestFrom(__builtin_return_address(0));
  return __libc_calloc(count, size);
}

void* realloc(void* pointer, size_t size) {
  palpate::test_support::CountRequestFrom(__builtin_return_address(0));
  return __libc_realloc(pointer, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
  palpate::test_support::CountRequestFrom(__builtin_return_address(0));
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** pointer, size_t alignment, size_t size) {
  palpate::test_support::CountRequestFrom(__builtin_return_address(0));
  *pointer = __libc_memalign(alignment, size);
  return *pointer == nullptr ? ENOMEM : 0;
}

}  // extern "C"
#endif
