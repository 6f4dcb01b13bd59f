// Warm start: the impulses of the last step, found again by the contact's key (the pair's tags).
// An open-addressing table of 16 B entries, refilled each step without allocating.
#pragma once

#include "contact.hpp"

#include <span>
#include <vector>

namespace nscd {

// How many contacts ahead a loop asks for an entry.
constexpr std::size_t prefetch_distance = 12;

class ImpulseMemory {
 public:
  // Forgets everything but these contacts' impulses.
  void remember(std::span<const Contact> contacts, std::span<const ContactInfo> infos);
  // The remembered impulse, N s, or 0 for a contact that was not there.
  double recall(std::uint64_t key) const;
  void forget();
  // Looks ahead: the entry of this key will be asked for soon. Large tables do not fit the cache.
  void prefetch(std::uint64_t key) const
  {
    if (!table_.empty()) __builtin_prefetch(&table_[slot(key)]);
  }

 private:
  struct Entry {
    std::uint64_t key;  // 0: free
    double impulse;
  };
  std::size_t slot(std::uint64_t key) const { return (key * 0x9E3779B97F4A7C15ull) >> shift_; }
  void grow(std::size_t contacts);

  std::vector<Entry> table_;
  int shift_ = 64;
  std::size_t used_ = 0;
};

}    // namespace nscd
