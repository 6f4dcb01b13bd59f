// SPDX-License-Identifier: GPL-2.0-or-later
#include "told_pair.hpp"

#include "settings/told_pairs.hpp"

namespace nscd {

const void *ToldPair::ask(const char *what) const
{
  return library_.extract_pair ? library_.extract_pair(library_.handle, what) : nullptr;
}

std::string ToldPair::materials() const
{
  const void *told = ask("nscd/materials");
  return told ? static_cast<const char *>(told) : "";
}

Settings ToldPair::with(const std::string &materials) const
{
  Settings settings = keywords_;
  if (materials.empty()) return settings;
  require_no_pairs(settings, "`materials`");
  take_told(settings, materials);
  return settings;
}

ToldList ToldPair::list() const
{
  const void *told = ask("nscd/list");
  return told ? ToldList::unpacked(static_cast<const double *>(told)) : ToldList{};
}

}    // namespace nscd
