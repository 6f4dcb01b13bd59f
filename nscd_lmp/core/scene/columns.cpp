// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/columns.hpp"

namespace nscd {

void Columns::resize(std::size_t rows)
{
  rows_ = rows;
  for (Any *column : all_)
    if (column->open_) column->set_size(rows);
}

void Columns::swap(std::size_t a, std::size_t b)
{
  for (Any *column : all_)
    if (column->open_) column->swap(a, b);
}

std::size_t Columns::bytes() const
{
  std::size_t sum = 0;
  for (const Any *column : all_) sum += column->bytes();
  return sum;
}

Columns::Any::Any(Columns &table, Starts starts) : table_(table), open_(starts == Starts::open)
{
  table.all_.push_back(this);
}

void Columns::Any::open()
{
  if (open_) return;
  open_ = true;
  set_size(table_.size());
}

void Columns::Any::close()
{
  open_ = false;
  set_size(0);
}

}    // namespace nscd
