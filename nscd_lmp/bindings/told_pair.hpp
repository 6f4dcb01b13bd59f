// SPDX-License-Identifier: GPL-2.0-or-later
// What pair_style nscd, where this LAMMPS has the plugin, tells by LAMMPS' C interface: materials and a list.
#pragma once

#include "library.hpp"
#include "scene/list/told_list.hpp"
#include "settings/settings.hpp"

#include <string>
#include <string_view>

namespace nscd {

class ToldPair {
 public:
  static constexpr std::string_view style = "nscd";

  // `keywords`: those of attach, which hold where the pair style says nothing. The library has to outlive it.
  ToldPair(const Library &library, const Settings &keywords) : library_(library), keywords_(keywords) {}

  // In words; empty where the style is not there, or is of a plugin that does not tell.
  std::string materials() const;
  // The keywords with these. Raises Error where both have materials by type.
  Settings with(const std::string &materials) const;
  // As it is now; number -1 if the style, or its list, is not there. After LAMMPS' setup.
  ToldList list() const;

  const Settings &keywords() const { return keywords_; }

 private:
  const void *ask(const char *what) const;

  const Library &library_;
  const Settings keywords_;
};

}    // namespace nscd
