// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/block_matrix.hpp"

#include "base/error.hpp"
#include "base/hot.hpp"

namespace nscd {

namespace {

template <int dim>
NSCD_HOT void multiply_blocks(const BlockMatrix &a, const double *x, double *y)
{
  for (std::size_t r = 0; r < a.rows(); ++r) {
    double sum[dim] = {};
    for (auto at = a.row_start[r]; at < a.row_start[r + 1]; ++at) {
      const double *block = &a.block[std::size_t(at) * dim * dim], *in = x + std::size_t(a.column[at]) * dim;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) sum[i] += block[dim * i + j] * in[j];
    }
    for (int i = 0; i < dim; ++i) y[r * dim + i] = sum[i];
  }
}

}    // namespace

void BlockMatrix::multiply(const double *x, double *y) const
{
  switch (dim) {
    case 1: return multiply_blocks<1>(*this, x, y);
    case 2: return multiply_blocks<2>(*this, x, y);
    case 3: return multiply_blocks<3>(*this, x, y);
    case 4: return multiply_blocks<4>(*this, x, y);
    case 5: return multiply_blocks<5>(*this, x, y);
    case 6: return multiply_blocks<6>(*this, x, y);
    default: fail("contacts have 1 to 6 unknowns, not ", dim);
  }
}

const double *BlockMatrix::diagonal(std::size_t row) const
{
  for (auto at = row_start[row]; at < row_start[row + 1]; ++at)
    if (std::size_t(column[at]) == row) return &block[std::size_t(at) * dim * dim];
  return nullptr;
}

}    // namespace nscd
