// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/materials.hpp"

#include "base/error.hpp"
#include "settings/settings.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

bool alike(const Material &a, const Material &b)
{
  return std::all_of(material_parts.begin(), material_parts.end(),
                     [&](const MaterialPart &part) { return a.*part.value == b.*part.value; });
}

bool has(const TypeRange &range, int type) { return type >= range.first && (range.last == 0 || type <= range.last); }

bool names(const PairMaterial &pair, int a, int b)
{
  return (has(pair.i, a) && has(pair.j, b)) || (has(pair.i, b) && has(pair.j, a));
}

void require_types(const TypeRange &range, int types)
{
  for (const int type : {range.first, range.last})
    if (type > types)
      fail("material: there is no atom type ", type, ", the largest is ", types, ": name types from 1 to ", types);
}

bool is_within(const TypeRange &one, const TypeRange &other)
{
  return one.first >= other.first && (other.last == 0 || (one.last != 0 && one.last <= other.last));
}

// Whether all that `one` says is said of the same pairs by `later` again.
bool hides(const PairMaterial &later, const PairMaterial &one)
{
  for (std::size_t part = 0; part < material_parts.size(); ++part)
    if (one.own.has(part) && !later.own.has(part)) return false;
  return (is_within(one.i, later.i) && is_within(one.j, later.j)) ||
      (is_within(one.i, later.j) && is_within(one.j, later.i));
}

void require_none_hidden(std::span<const PairMaterial> pairs)
{
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (std::size_t later = k + 1; later < pairs.size(); ++later)
      if (hides(pairs[later], pairs[k]))
        fail("material ", pairs[later].types, " stands behind material ", pairs[k].types, " and takes all that it ",
             "says, since of several the last one holds: give what is meant for more types first, and each pair once");
}

bool has_own(const Settings &s, int a, int b)
{
  return std::any_of(s.pairs.begin(), s.pairs.end(), [&](const PairMaterial &pair) { return names(pair, a, b); });
}

Material own_of_types(const Settings &s, int a, int b)
{
  Material material = s.material;
  for (const PairMaterial &pair : s.pairs)
    if (names(pair, a, b)) material = pair.own.over(material);
  return material;
}

// Number by number. What one of the two has none of, the pair has none of, also beside a friction without bound.
Material mixed(const Material &a, const Material &b, Mixing how)
{
  Material both;
  for (const MaterialPart &part : material_parts) {
    const double one = a.*part.value, other = b.*part.value;
    if (how == Mixing::arithmetic) both.*part.value = 0.5 * (one + other);
    else both.*part.value = one == 0 || other == 0 ? 0 : std::sqrt(one) * std::sqrt(other);
  }
  return both;
}

void require_effect(const OwnMaterial &own, bool rubs, const std::string &whose)
{
  const double e_t = own.over({}).e_t;
  if (e_t > 0 && !rubs)
    fail(whose, ": e_t = ", e_t, " has no effect without friction: give `friction`, or leave e_t out");
}

}    // namespace

Materials::Materials(const Settings &s, int types) : types_(types)
{
  require_pairs_named(s);
  require_none_hidden(s.pairs);
  for (int a = 0; a <= types; ++a)
    for (int b = 0; b <= types; ++b) {
      pairs_.push_back(number_of(a > 0 && b > 0 ? of_types(s, a, b) : s.material));
      by_type_ |= a > 0 && b > 0 && pairs_.back() != pairs_[std::size_t(types) + 2];   // pair 1 1
    }
  for (const Wall &wall : s.walls) {
    const Material material = wall.own.over(s.material);
    require_effect(wall.own, material.friction > 0, wall.name);
    walls_.push_back(number_of(material));
  }
  require_effects(s);
  for (const Material &material : all_) {
    may_make_energy_ |= material.restitution != all_[0].restitution;
    may_make_energy_ |= s.frictional() && material.restitution != material.e_t;
  }
}

Material Materials::of_types(const Settings &s, int a, int b) const
{
  if (s.mixing == Mixing::none || a == b || has_own(s, a, b)) return own_of_types(s, a, b);
  return mixed(own_of_types(s, a, a), own_of_types(s, b, b), s.mixing);
}

void Materials::require_effects(const Settings &s) const
{
  for (const PairMaterial &pair : s.pairs) {
    bool rubs = false;
    for (int a = 1; a <= types_; ++a)
      for (int b = 1; b <= types_; ++b) rubs = rubs || (names(pair, a, b) && all_[of_pair(a, b)].friction > 0);
    require_effect(pair.own, rubs, "material " + pair.types);
  }
}

MaterialNumber Materials::number_of(const Material &material)
{
  const auto same = [&](const Material &other) { return alike(material, other); };
  const auto found = std::find_if(all_.begin(), all_.end(), same);
  const std::size_t number = std::size_t(found - all_.begin());
  if (number > std::numeric_limits<MaterialNumber>::max()) fail("there are more than ", number, " different materials");
  if (found == all_.end()) all_.push_back(material);
  return MaterialNumber(number);
}

void Materials::require_pairs_named(const Settings &s) const
{
  for (const PairMaterial &pair : s.pairs) {
    require_types(pair.i, types_);
    require_types(pair.j, types_);
  }
  if (s.mixing != Mixing::none) return;
  for (int a = 1; a <= types_; ++a)
    for (int b = a + 1; b <= types_; ++b)
      if (has_own(s, a, a) && has_own(s, b, b) && !has_own(s, a, b))
        fail("grains of types ", a, " and ", b, " have materials of their own, and the pair of the two has none: give ",
             "`material ", a, " ", b, "` too");
}

}    // namespace nscd
