// SPDX-License-Identifier: GPL-2.0-or-later
// A sparse matrix of small dense blocks by rows: a Delassus matrix, contact by contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nscd {

struct BlockMatrix {
  int dim = 1;                             // blocks are dim x dim
  std::vector<std::int64_t> row_start{0};  // (rows + 1) into column
  std::vector<std::int32_t> column{};      // (blocks)
  std::vector<double> block{};             // (blocks, dim, dim), row by row

  std::size_t rows() const { return row_start.size() - 1; }

  // y = A x, both (rows, dim).
  void multiply(const double *x, double *y) const;

  // The block on the diagonal of this row, or null if none is stored.
  const double *diagonal(std::size_t row) const;
};

}    // namespace nscd
