// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/cholmod_context.hpp"

#include <SuiteSparse_config.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>

// OpenBLAS, where the BLAS in use is OpenBLAS: its threads cost more than they bring on fronts of
// this size, and they would compete with our own.
extern "C" void openblas_set_num_threads(int count) __attribute__((weak));

namespace palpate::fem::internal {

namespace {

/// Blocks of 2^k bytes in free lists. CHOLMOD asks for the same sizes in every factorisation, so
/// after the first one every request is served from the lists. Blocks are never given back to the
/// system: the peak of one factorisation is what the process needs anyway.
class BlockPool {
 public:
  void* Allocate(size_t bytes) {
    const int order = Order(bytes + sizeof(Header));
    const std::lock_guard lock(mutex_);
    Header* block = free_[static_cast<size_t>(order)];
    if (block != nullptr) {
      free_[static_cast<size_t>(order)] = block->next;
    } else {
      block = static_cast<Header*>(std::malloc(size_t{1} << order));
      if (block == nullptr) return nullptr;
      block->order = order;
    }
    return block + 1;
  }

  void Release(void* pointer) {
    if (pointer == nullptr) return;
    Header* block = static_cast<Header*>(pointer) - 1;
    const std::lock_guard lock(mutex_);
    block->next = free_[static_cast<size_t>(block->order)];
    free_[static_cast<size_t>(block->order)] = block;
  }

  void* Reallocate(void* pointer, size_t bytes) {
    if (pointer == nullptr) return Allocate(bytes);
    const Header* block = static_cast<Header*>(pointer) - 1;
    const size_t capacity = (size_t{1} << block->order) - sizeof(Header);
    if (bytes <= capacity) return pointer;
    void* larger = Allocate(bytes);
    if (larger == nullptr) return nullptr;
    std::memcpy(larger, pointer, capacity);
    Release(pointer);
    return larger;
  }

 private:
  struct alignas(64) Header {
    int order;
    Header* next;
  };

  static int Order(size_t bytes) { return static_cast<int>(std::bit_width(bytes - 1)); }

  std::mutex mutex_;
  std::array<Header*, 64> free_{};
};

/// Lives as long as the process: SuiteSparse's hooks are global.
BlockPool& Pool() {
  static BlockPool* pool = new BlockPool;
  return *pool;
}

void* PoolMalloc(size_t bytes) { return Pool().Allocate(bytes); }
void* PoolCalloc(size_t count, size_t size) {
  void* pointer = Pool().Allocate(count * size);
  if (pointer != nullptr) std::memset(pointer, 0, count * size);
  return pointer;
}
void* PoolRealloc(void* pointer, size_t bytes) { return Pool().Reallocate(pointer, bytes); }
void PoolFree(void* pointer) { Pool().Release(pointer); }

void InstallPool() {
  static std::once_flag once;
  std::call_once(once, [] {
    SuiteSparse_config.malloc_func = PoolMalloc;
    SuiteSparse_config.calloc_func = PoolCalloc;
    SuiteSparse_config.realloc_func = PoolRealloc;
    SuiteSparse_config.free_func = PoolFree;
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  });
}

}  // namespace

CholmodContext::CholmodContext() {
  InstallPool();
  cholmod_start(&common_);
  common_.print = 0;
  common_.quick_return_if_not_posdef = 1;
}

CholmodContext::~CholmodContext() { cholmod_finish(&common_); }

}  // namespace palpate::fem::internal
