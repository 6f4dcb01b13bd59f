// A vector on cache lines. std::vector places Vec4 by the alignment that the baseline instruction set asks for (16 B),
// which is too little where AVX2 code reads it.
#pragma once

#include <new>
#include <vector>

namespace nscd {

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U> &) {}
  T *allocate(std::size_t n) { return static_cast<T *>(::operator new(n * sizeof(T), line)); }
  void deallocate(T *p, std::size_t) { ::operator delete(p, line); }
  bool operator==(const CacheLineAllocator &) const = default;
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}    // namespace nscd
