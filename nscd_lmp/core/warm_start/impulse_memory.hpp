// SPDX-License-Identifier: GPL-2.0-or-later
// Warm start: the impulses of the last step, found again by the contact's key (the pair's tags).
// An open-addressing table, refilled each step without allocating. Entry: what a contact's impulse is, with a
// `std::uint64_t key` that is 0 for a free place.
#pragma once

#include "contact/contact.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace nscd {

// How many contacts ahead a loop asks for an entry.
constexpr std::size_t prefetch_distance = 12;

// What a contact is remembered by: its key, its impulse along the normal and in its discs and, where that turns with
// it, its normal (remembered.hpp). With friction in space one cache line.
template <std::size_t count>
struct Remembered {
  std::uint64_t key = 0;
  std::array<double, count> numbers{};
};

// The grains of a contact's key (contact_geometry.hpp), the lower tag first; 0 for a wall.
inline std::array<std::int32_t, 2> tags_of(std::uint64_t key)
{
  const bool wall = key >> 63;
  return {wall ? 0 : std::int32_t(key >> 32), std::int32_t(key & 0xFFFFFFFF)};
}

// An entry as numbers, bit by bit, for messages and files.
template <class Entry>
using Words = std::array<double, sizeof(Entry) / sizeof(double)>;

template <class Entry>
Words<Entry> as_words(const Entry &entry)
{
  static_assert(std::is_trivially_copyable_v<Entry> && sizeof(Entry) % sizeof(double) == 0);
  return std::bit_cast<Words<Entry>>(entry);
}

template <class Entry>
Entry from_words(const double *from)
{
  Words<Entry> words;
  std::copy_n(from, words.size(), words.begin());
  return std::bit_cast<Entry>(words);
}

template <class Entry>
class ImpulseMemory {
 public:
  // Forgets everything but these contacts: entry(k) is what contact k is remembered by.
  template <class EntryOf>
  void remember(std::span<const ContactInfo> infos, EntryOf entry)
  {
    grow(infos.size());
    forget();
    for (std::size_t k = 0; k < infos.size(); ++k) {
      if (k + prefetch_distance < infos.size()) prefetch(infos[k + prefetch_distance].key);
      put(entry(k));
    }
    used_ = infos.size();
  }

  // What the contact was remembered by, or null for one that was not there.
  const Entry *recall(std::uint64_t key) const
  {
    if (used_ == 0) return nullptr;
    const std::size_t last = table_.size() - 1;
    for (std::size_t s = slot(key); table_[s].key != 0; s = (s + 1) & last)
      if (table_[s].key == key) return &table_[s];
    return nullptr;
  }

  void forget()
  {
    if (used_ == 0) return;
    std::fill(table_.begin(), table_.end(), Entry{});
    used_ = 0;
  }

  // All entries, in no order that means anything.
  template <class Visit>
  void for_each(Visit visit) const
  {
    for (const Entry &e : table_)
      if (e.key != 0) visit(e);
  }

  // Adds one that is not there yet.
  void add(const Entry &entry)
  {
    if (recall(entry.key)) return;
    std::vector<Entry> kept;
    if (3 * (used_ + 1) > 2 * table_.size()) {   // a larger table puts entries elsewhere
      for_each([&](const Entry &e) { kept.push_back(e); });
      forget();
      grow(2 * kept.size() + 1);
    }
    for (const Entry &e : kept) put(e);
    used_ = kept.empty() ? used_ : kept.size();
    put(entry);
    ++used_;
  }

  // Looks ahead: the entry of this key will be asked for soon. Large tables do not fit the cache.
  void prefetch(std::uint64_t key) const
  {
    if (!table_.empty()) __builtin_prefetch(&table_[slot(key)]);
  }

 private:
  void put(const Entry &entry)
  {
    const std::size_t last = table_.size() - 1;
    std::size_t s = slot(entry.key);
    while (table_[s].key != 0) s = (s + 1) & last;
    table_[s] = entry;
  }

  std::size_t slot(std::uint64_t key) const { return (key * 0x9E3779B97F4A7C15ull) >> shift_; }

  // Power of two, at most two thirds full, so that a look-up of an absent key ends soon.
  void grow(std::size_t contacts)
  {
    int bits = 6;
    while (2 * (std::size_t(1) << bits) < 3 * contacts) ++bits;
    const std::size_t size = std::size_t(1) << bits;
    if (size <= table_.size()) return;
    table_.resize(size);
    shift_ = 64 - bits;
  }

  std::vector<Entry> table_;
  int shift_ = 64;
  std::size_t used_ = 0;
};

}    // namespace nscd
