// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>

namespace nscd {

namespace {

// What LAMMPS' create_atoms gives a sphere: diameter 1, density 1. `set diameter` leaves the mass as it is.
constexpr double default_radius = 0.5, default_mass = 4 * std::numbers::pi / 3 * 0.125;

template <class... Parts>
std::string sentence(const Parts &...parts)
{
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

bool never_weighed(const Grains &g, int i)
{
  return std::abs(g.mass[i] - default_mass) < 1e-14 && std::abs(g.radius[i] - default_radius) > 1e-6;
}

}    // namespace

std::vector<std::string> doubts(const Grains &g, double atoms, Ranks *ranks)
{
  double grains[2] = {}, last_tag = 0;
  for (int i = 0; i < g.owned; ++i) {
    last_tag = std::max<double>(last_tag, g.tag[i]);
    if (!(g.mask[i] & g.group)) continue;
    grains[0] += 1;
    grains[1] += never_weighed(g, i);
  }
  if (ranks) {
    ranks->sum(grains);
    ranks->max({&last_tag, 1});
  }
  std::vector<std::string> told;
  const std::int64_t weightless = grains[1], all = grains[0], last = last_tag, there = atoms;
  if (weightless > 0)
    told.push_back(sentence(weightless, " of ", all, " grains have the mass ", default_mass, " of a sphere of diameter "
                            "1 and density 1, which create_atoms gives, but another radius: their masses were never "
                            "set, and `set ... diameter` does not change them. Use `set group all density` or `mass`"));
  if (last > there)
    told.push_back(sentence("atom IDs reach ", last, ", but there are ", there, " atoms: create_atoms leaves out those "
                            "outside the box. If that is meant, `reset_atoms id` numbers them anew"));
  return told;
}

}    // namespace nscd
