// SPDX-License-Identifier: GPL-2.0-or-later
#include "counted_new.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

static Heap counted{};

Heap heap() { return counted; }

// The size stands before the memory that is handed out, a whole alignment away.
static std::size_t room(std::size_t alignment) { return std::max(alignment, alignof(std::max_align_t)); }

static void *allocate(std::size_t size, std::size_t alignment)
{
  const std::size_t offset = room(alignment), whole = (size + 2 * offset - 1) / offset * offset;
  char *base = static_cast<char *>(std::aligned_alloc(offset, whole));
  if (!base) throw std::bad_alloc();
  *reinterpret_cast<std::size_t *>(base) = size;
  ++counted.allocations;
  counted.bytes += size;
  return base + offset;
}

static void release(void *memory, std::size_t alignment)
{
  if (!memory) return;
  char *base = static_cast<char *>(memory) - room(alignment);
  counted.bytes -= *reinterpret_cast<std::size_t *>(base);
  std::free(base);
}

void *operator new(std::size_t size) { return allocate(size, 1); }
void *operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, std::size_t(alignment)); }
void operator delete(void *memory) noexcept { release(memory, 1); }
void operator delete(void *memory, std::size_t) noexcept { release(memory, 1); }
void operator delete(void *memory, std::align_val_t alignment) noexcept { release(memory, std::size_t(alignment)); }
void operator delete(void *memory, std::size_t, std::align_val_t alignment) noexcept
{
  release(memory, std::size_t(alignment));
}
