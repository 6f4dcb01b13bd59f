// Memory of the core: a vector on cache lines, and vectors that grow closely.
//
// std::vector places Vec4 by the alignment that the baseline instruction set asks for (16 B), which is too little where
// AVX2 code reads it.
#pragma once

#include <cstddef>
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

// resize() that keeps a sixteenth in reserve where the standard one doubles: contacts are most of the memory.
template <class Vector>
void resize_closely(Vector &v, std::size_t n)
{
  if (n > v.capacity()) v.reserve(n + n / 16);
  v.resize(n);
}

}    // namespace nscd
