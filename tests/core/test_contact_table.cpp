// SPDX-License-Identifier: GPL-2.0-or-later
// The table of contacts: whatever adds, drops or reorders rows keeps all arrays beside contacts in step.
#include "check.hpp"
#include "scene.hpp"
#include "scene/contact_table.hpp"

#include <algorithm>
#include <numeric>

using nscd::ContactTable;

// Every column of row k says `mark`.
static void mark(ContactTable &table, std::size_t k, int mark)
{
  table.contacts[k].i = mark;
  table.infos[k].key = std::uint64_t(mark);
  table.planar[k].mu = mark;
  table.spatial[k].mu = mark;
  for (auto *const numbers : {&table.per_approach, &table.impact_impulse, &table.impact_moment, &table.impact_kick})
    if (numbers->is_open()) (*numbers)[k] = mark;
  table.impact_tangential[k] = nscd::Vec4{double(mark), 0, 0, 0};
  table.material[k] = nscd::MaterialNumber(mark);
}

static bool says(const ContactTable &table, std::size_t k, int mark)
{
  bool same = table.contacts[k].i == mark && table.infos[k].key == std::uint64_t(mark) &&
      table.planar[k].mu == mark && table.spatial[k].mu == mark && table.impact_tangential[k][0] == mark;
  for (const auto *const numbers : {&table.per_approach, &table.impact_impulse, &table.impact_moment})
    same &= (*numbers)[k] == mark;
  return same && table.material[k] == nscd::MaterialNumber(mark);
}

static bool is_in_step(const ContactTable &table)
{
  const auto fits = [&](const auto *column) { return column->size() == (column->is_open() ? table.size() : 0); };
  return std::all_of(table.all().begin(), table.all().end(), fits);
}

// impact_kick stays closed.
static void open_all_but_one(ContactTable &table)
{
  table.planar.open();
  table.spatial.open();
  table.material.open();
  table.per_approach.open();
  table.impact_impulse.open();
  table.impact_tangential.open();
  table.impact_moment.open();
}

TEST(rows_of_a_contact_table_stay_together)
{
  Random random(5);
  ContactTable table;
  open_all_but_one(table);
  std::vector<int> order;
  for (int round = 0; round < 50; ++round) {
    const std::size_t rows = std::size_t(random(1, 200));
    const std::size_t before = std::min(rows, order.size());
    order.resize(rows);
    std::iota(order.begin() + std::ptrdiff_t(before), order.end(), 1000 * round);
    table.resize(rows);
    CHECK(is_in_step(table) && table.size() == rows);
    for (std::size_t k = before; k < rows; ++k) mark(table, k, order[k]);
    for (int swaps = 0; swaps < 100; ++swaps) {
      const std::size_t a = std::size_t(random(0, double(rows))), b = std::size_t(random(0, double(rows)));
      table.swap(a, b);
      std::swap(order[a], order[b]);
    }
    bool same = true;
    for (std::size_t k = 0; k < rows; ++k) same &= says(table, k, order[k]);
    CHECK(same && table.impact_kick.size() == 0);
  }
}

TEST(a_column_is_as_long_as_its_table_or_closed)
{
  ContactTable table;
  CHECK(table.all().size() == 10 && table.contacts.is_open() && !table.per_approach.is_open());
  table.resize(3);
  CHECK(is_in_step(table) && table.per_approach.size() == 0);
  table.per_approach.open();
  table.per_approach[1] = 5;
  table.per_approach.open();   // keeps what is there
  CHECK(is_in_step(table) && table.per_approach[1] == 5);
  table.per_approach.close();
  table.resize(4);
  CHECK(is_in_step(table));
  table.per_approach.open();
  CHECK(table.per_approach[1] == 0 && table.per_approach.size() == 4);
  CHECK(table.bytes() >= 4 * (sizeof(nscd::Contact) + sizeof(nscd::ContactInfo) + sizeof(double)));
}
