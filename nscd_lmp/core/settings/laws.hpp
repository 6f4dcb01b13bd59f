// The one list of the contact laws, and what settings have to know of one.
//
// A law is a class (scheme/law.hpp); its file registers it, and every choice list reads the registry.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

namespace nscd {

class Law;

struct LawEntry {
  int order;
  std::string_view name;
  std::string_view title;
  bool looks_ahead;             // contacts are sought within dt times the speeds, or only where spheres touch
  std::unique_ptr<Law> (*make)();
};

const std::vector<LawEntry> &laws();
const LawEntry &find_law(std::string_view name);    // Raises Error naming the choices.

struct RegisterLaw {
  explicit RegisterLaw(const LawEntry &entry);
};

}    // namespace nscd
