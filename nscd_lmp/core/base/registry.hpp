// SPDX-License-Identifier: GPL-2.0-or-later
// A list of named entries that files add themselves to while the library is loaded.
#pragma once

#include "base/error.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace nscd {

// Entry needs `int order` and `std::string_view name`.
template <class Entry>
class Registry {
 public:
  void add(const Entry &entry)
  {
    const auto later = [](const Entry &a, const Entry &b) { return a.order < b.order; };
    entries_.insert(std::upper_bound(entries_.begin(), entries_.end(), entry, later), entry);
  }

  const std::vector<Entry> &entries() const { return entries_; }

  const Entry &find(std::string_view what, std::string_view name) const
  {
    for (const Entry &entry : entries_)
      if (entry.name == name) return entry;
    std::string choices;
    for (const Entry &entry : entries_)
      choices.append(choices.empty() ? "" : ", ").append(entry.name);
    fail("unknown ", what, " '", name, "': choose one of ", choices);
  }

 private:
  std::vector<Entry> entries_;
};

}    // namespace nscd
