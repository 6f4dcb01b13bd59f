// SPDX-License-Identifier: GPL-2.0-or-later
#include "check.hpp"
#include "warm_start/impulse_memory.hpp"

#include <vector>

struct Remembered {
  std::vector<double> impulses;
  std::vector<nscd::ContactInfo> infos;
  void add(std::uint64_t key, double impulse)
  {
    impulses.push_back(impulse);
    infos.push_back({0, 0, key, 0, 1});
  }
};

struct Memory : nscd::ImpulseMemory<nscd::Remembered<1>> {
  void remember(const Remembered &r)
  {
    ImpulseMemory::remember(r.infos, [&](std::size_t k) {
      return nscd::Remembered<1>{r.infos[k].key, {r.impulses[k]}};
    });
  }
  double recall(std::uint64_t key) const
  {
    const auto *known = ImpulseMemory::recall(key);
    return known ? known->numbers[0] : 0;
  }
};

TEST(an_empty_memory_recalls_nothing)
{
  Memory memory;
  CHECK(memory.recall(1) == 0);
  memory.remember({});
  CHECK(memory.recall(1) == 0);
  memory.forget();
  CHECK(memory.recall(1) == 0);
}

TEST(impulses_are_recalled_by_key_and_absent_keys_give_zero)
{
  Remembered r;
  for (std::uint64_t k = 1; k <= 1000; ++k) r.add(k << 32 | (k + 7), double(k));
  Memory memory;
  memory.remember(r);
  for (std::uint64_t k = 1; k <= 1000; ++k) {
    CHECK(memory.recall(k << 32 | (k + 7)) == double(k));
    CHECK(memory.recall(k << 32 | (k + 8)) == 0);
  }
}

// Neighboring tags, the top bit of walls, and keys that differ by multiples of 2^58 land in few slots of a small table.
TEST(colliding_keys_are_kept_apart)
{
  for (const std::uint64_t stride : {std::uint64_t(1), std::uint64_t(1) << 32, std::uint64_t(1) << 58}) {
    Remembered r;
    for (std::uint64_t k = 1; k <= 16; ++k) r.add(k * stride, double(k));
    Memory memory;
    memory.remember(r);
    for (std::uint64_t k = 1; k <= 16; ++k) CHECK(memory.recall(k * stride) == double(k));
    for (std::uint64_t k = 17; k <= 48; ++k) CHECK(memory.recall(k * stride + 1) == 0);
  }
}

// In a table of 64 slots, 16 entries that all want the last one wrap around to the first.
TEST(a_probe_wraps_around_the_end_of_the_table)
{
  Remembered r;
  const auto slot = [](std::uint64_t key) { return (key * 0x9E3779B97F4A7C15ull) >> 58; };
  std::uint64_t key = 1;
  for (; r.infos.size() < 16; ++key)
    if (slot(key) == 63) r.add(key, double(key));
  Memory memory;
  memory.remember(r);
  for (const auto &info : r.infos) CHECK(memory.recall(info.key) == double(info.key));
  while (slot(key) != 63) ++key;
  CHECK(memory.recall(key) == 0);
}

TEST(the_memory_grows_and_shrinks_with_the_contacts)
{
  Memory memory;
  for (const std::uint64_t n : {5u, 20000u, 3u, 40u, 100000u, 0u, 1u}) {
    Remembered r;
    for (std::uint64_t k = 1; k <= n; ++k) r.add(k + n, double(k));
    memory.remember(r);
    for (std::uint64_t k = 1; k <= n; ++k) CHECK(memory.recall(k + n) == double(k));
    CHECK(memory.recall(n) == 0);
    CHECK(memory.recall(2 * n + 1) == 0);
  }
}

TEST(forgetting_and_remembering_drop_what_was_there)
{
  Remembered first, second;
  first.add(11, 1.5);
  second.add(12, 2.5);
  Memory memory;
  memory.remember(first);
  memory.remember(second);
  CHECK(memory.recall(11) == 0);
  CHECK(memory.recall(12) == 2.5);
  memory.forget();
  CHECK(memory.recall(12) == 0);
  memory.remember(first);
  CHECK(memory.recall(11) == 1.5);
}

TEST(zero_impulses_take_no_room_and_tensile_ones_are_kept)
{
  Remembered r;
  r.add(5, 0.0);
  r.add(6, -1.0);
  Memory memory;
  memory.remember(r);
  CHECK(memory.recall(5) == 0);
  CHECK(memory.recall(6) == -1.0);
}
