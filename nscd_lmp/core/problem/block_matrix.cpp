// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/block_matrix.hpp"

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
  if (dim == 1) multiply_blocks<1>(*this, x, y);
  if (dim == 2) multiply_blocks<2>(*this, x, y);
  if (dim == 3) multiply_blocks<3>(*this, x, y);
}

const double *BlockMatrix::diagonal(std::size_t row) const
{
  for (auto at = row_start[row]; at < row_start[row + 1]; ++at)
    if (std::size_t(column[at]) == row) return &block[std::size_t(at) * dim * dim];
  return nullptr;
}

}    // namespace nscd
