// SPDX-License-Identifier: GPL-2.0-or-later
// What operator new handed out, in this program.
#pragma once

#include <cstddef>

struct Heap {
  std::size_t allocations;  // since the start
  std::size_t bytes;        // in use now, as asked for
};
Heap heap();
