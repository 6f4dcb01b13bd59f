#include "settings/laws.hpp"

#include "base/registry.hpp"

namespace nscd {

static Registry<LawEntry> &registry()
{
  static Registry<LawEntry> list;
  return list;
}

RegisterLaw::RegisterLaw(const LawEntry &entry) { registry().add(entry); }

const std::vector<LawEntry> &laws() { return registry().entries(); }

const LawEntry &find_law(std::string_view name) { return registry().find("law", name); }

}    // namespace nscd
