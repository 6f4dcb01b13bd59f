// SPDX-License-Identifier: GPL-2.0-or-later
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

// reserve() and resize() that keep a sixteenth more where the standard ones double: contacts are most of the memory.
template <class Vector>
void reserve_closely(Vector &v, std::size_t n)
{
  if (n > v.capacity()) v.reserve(n + n / 16);
}

template <class Vector>
void resize_closely(Vector &v, std::size_t n)
{
  reserve_closely(v, n);
  v.resize(n);
}

}    // namespace nscd
