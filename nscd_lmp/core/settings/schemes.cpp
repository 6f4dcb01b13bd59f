// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/schemes.hpp"

#include "base/registry.hpp"

namespace nscd {

static Registry<SchemeEntry> &registry()
{
  static Registry<SchemeEntry> list;
  return list;
}

RegisterScheme::RegisterScheme(const SchemeEntry &entry) { registry().add(entry); }

const std::vector<SchemeEntry> &schemes() { return registry().entries(); }

const SchemeEntry &find_scheme(std::string_view name) { return registry().find("law", name); }

}    // namespace nscd
