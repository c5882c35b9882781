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
#include <string_view>

#include "libs/core/index.hpp"

// OpenBLAS, where the BLAS in use is OpenBLAS, and the OpenMP that CHOLMOD was built with, if any.
extern "C" {
void openblas_set_num_threads(int count) __attribute__((weak));
char* openblas_get_corename() __attribute__((weak));
void gotoblas_dynamic_quit() __attribute__((weak));
void gotoblas_dynamic_init() __attribute__((weak));
int omp_get_max_active_levels() __attribute__((weak));
void omp_set_max_active_levels(int levels) __attribute__((weak));
}

namespace palpate::fem::internal {

namespace {

/// Whether this thread is inside a SolveMemoryScope: 1, else 0.
thread_local int memory_use = 0;

/// Blocks of 2^k bytes in free lists, apart for each use. CHOLMOD asks for the same sizes in every
/// factorisation, so after the first one every request is served from the lists. Blocks are never
/// given back to the system: the peak of one factorisation is what the process needs anyway.
class BlockPool {
 public:
  void* Allocate(size_t bytes) {
    const int order = Order(bytes + sizeof(Header));
    const std::lock_guard lock(mutex_);
    Header*& first = FirstFree(memory_use, order);
    Header* block = first;
    if (block != nullptr) {
      first = block->next;
    } else {
      block = static_cast<Header*>(std::aligned_alloc(alignof(Header), size_t{1} << order));
      if (block == nullptr) return nullptr;
      block->order = order;
      block->use = memory_use;
    }
    return block + 1;
  }

  void Release(void* pointer) {
    if (pointer == nullptr) return;
    Header* block = static_cast<Header*>(pointer) - 1;
    const std::lock_guard lock(mutex_);
    Header*& first = FirstFree(block->use, block->order);
    block->next = first;
    first = block;
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
    int use;
    Header* next;
  };

  static int Order(size_t bytes) { return static_cast<int>(std::bit_width(bytes - 1)); }

  Header*& FirstFree(int use, int order) { return free_[At(use)][At(order)]; }

  std::mutex mutex_;
  std::array<std::array<Header*, 64>, 2> free_{};
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

/// What OpenBLAS is to use instead of `core`, the kernels it chose; null: nothing better. To a
/// processor younger than itself OpenBLAS gives kernels of 2004, without AVX.
const char* BetterBlasCore([[maybe_unused]] std::string_view core) {
#if defined(__x86_64__)
  const bool without_avx = core == "Prescott" || core == "Core2" || core == "Nehalem";
  if (!without_avx || !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    return nullptr;
  }
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  return avx512 ? "SkylakeX" : "Haswell";
#else
  return nullptr;
#endif
}

/// OPENBLAS_CORETYPE, where the user gives it, stands.
void ChooseBlasKernels() {
  constexpr const char* kVariable = "OPENBLAS_CORETYPE";
  if (openblas_get_corename == nullptr || gotoblas_dynamic_quit == nullptr ||
      gotoblas_dynamic_init == nullptr || std::getenv(kVariable) != nullptr) {
    return;
  }
  const char* better = BetterBlasCore(openblas_get_corename());
  if (better == nullptr) return;
  setenv(kVariable, better, 1);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(kVariable);
}

/// BLAS threads cost more than they bring on fronts of this size, and would compete with our own.
void PrepareLibraries() {
  static std::once_flag once;
  std::call_once(once, [] {
    SuiteSparse_config.malloc_func = PoolMalloc;
    SuiteSparse_config.calloc_func = PoolCalloc;
    SuiteSparse_config.realloc_func = PoolRealloc;
    SuiteSparse_config.free_func = PoolFree;
    ChooseBlasKernels();
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  });
}

}  // namespace

SolveMemoryScope::SolveMemoryScope() { memory_use = 1; }
SolveMemoryScope::~SolveMemoryScope() { memory_use = 0; }

CholmodContext::CholmodContext() {
  PrepareLibraries();
  cholmod_start(&common_);
  common_.print = 0;
  common_.quick_return_if_not_posdef = 1;
}

CholmodContext::~CholmodContext() { cholmod_finish(&common_); }

OneThread::OneThread() {
  if (omp_get_max_active_levels == nullptr || omp_set_max_active_levels == nullptr) return;
  levels_before_ = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
}

OneThread::~OneThread() {
  if (levels_before_ >= 0) omp_set_max_active_levels(levels_before_);
}

}  // namespace palpate::fem::internal
