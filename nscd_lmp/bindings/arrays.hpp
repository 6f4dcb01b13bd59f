// SPDX-License-Identifier: GPL-2.0-or-later
// numpy arrays that own their memory.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>

namespace nscd {

// A new numpy array of `count` rows of `columns` values (columns 0: one-dimensional), filled by value(row, column).
template <class T, class Value>
nanobind::ndarray<nanobind::numpy, T> make_array(std::size_t count, std::size_t columns, Value value)
{
  const std::size_t width = std::max<std::size_t>(columns, 1);
  T *data = new T[std::max<std::size_t>(count * width, 1)];
  nanobind::capsule owner(data, [](void *p) noexcept { delete[] static_cast<T *>(p); });
  for (std::size_t r = 0; r < count; ++r)
    for (std::size_t c = 0; c < width; ++c) data[r * width + c] = value(r, c);
  const std::size_t shape[2] = {count, columns};
  return nanobind::ndarray<nanobind::numpy, T>(data, columns ? 2 : 1, shape, owner);
}

}    // namespace nscd
