// SPDX-License-Identifier: GPL-2.0-or-later
// The one list of the schemes of time stepping, keyword `law`, and what settings have to know of one.
//
// A scheme is a class (scheme/scheme.hpp); its file registers it, and every choice list reads the registry.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

namespace nscd {

class Scheme;
struct Settings;

struct SchemeEntry {
  int order;
  std::string_view name;
  std::string_view title;
  bool looks_ahead;             // contacts are sought within dt times the speeds, or only where spheres touch
  std::unique_ptr<Scheme> (*make)(const Settings &);
};

const std::vector<SchemeEntry> &schemes();
const SchemeEntry &find_scheme(std::string_view name);    // Raises Error naming the choices.

struct RegisterScheme {
  explicit RegisterScheme(const SchemeEntry &entry);
};

}    // namespace nscd
