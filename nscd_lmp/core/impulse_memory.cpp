#include "impulse_memory.hpp"

#include <algorithm>

namespace nscd {

// Power of two, at most two thirds full, so that a look-up of an absent key ends soon.
void ImpulseMemory::grow(std::size_t contacts)
{
  int bits = 6;
  while (2 * (std::size_t(1) << bits) < 3 * contacts) ++bits;
  const std::size_t size = std::size_t(1) << bits;
  if (size <= table_.size()) return;
  table_.resize(size);
  shift_ = 64 - bits;
}

void ImpulseMemory::remember(std::span<const Contact> contacts, std::span<const ContactInfo> infos)
{
  grow(contacts.size());
  forget();
  const std::size_t last = table_.size() - 1;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (k + prefetch_distance < infos.size()) prefetch(infos[k + prefetch_distance].key);
    std::size_t s = slot(infos[k].key);
    while (table_[s].key != 0) s = (s + 1) & last;
    table_[s] = {infos[k].key, contacts[k].impulse};
  }
  used_ = contacts.size();
}

double ImpulseMemory::recall(std::uint64_t key) const
{
  if (used_ == 0) return 0;
  const std::size_t last = table_.size() - 1;
  for (std::size_t s = slot(key); table_[s].key != 0; s = (s + 1) & last)
    if (table_[s].key == key) return table_[s].impulse;
  return 0;
}

void ImpulseMemory::forget()
{
  if (used_ == 0) return;
  std::fill(table_.begin(), table_.end(), Entry{0, 0});
  used_ = 0;
}

}    // namespace nscd
