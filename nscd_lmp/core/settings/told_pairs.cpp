// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings/told_pairs.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace nscd {

namespace {

constexpr std::array<std::string_view, 3> mixing_names{"none", "geometric", "arithmetic"};   // in the order of Mixing

Mixing read_mixing(std::istream &line)
{
  std::string word, name;
  line >> word >> name;
  const auto found = std::find(mixing_names.begin(), mixing_names.end(), name);
  if (word != "mix" || found == mixing_names.end())
    fail("materials of pairs are mixed by '", name, "', an unknown way");
  return Mixing(found - mixing_names.begin());
}

PairMaterial read_pair(std::istream &line)
{
  PairMaterial pair;
  line >> pair.i.first >> pair.j.first;
  if (!line) fail("a line of the materials of pairs does not begin with two types");
  pair.i.last = pair.i.first;
  pair.j.last = pair.j.first;
  pair.types = std::to_string(pair.i.first) + " " + std::to_string(pair.j.first);
  std::vector<std::string> words;
  for (std::string word; line >> word;) words.push_back(word);
  pair.own = read_own_material(words);
  return pair;
}

}    // namespace

std::string told(const std::vector<PairMaterial> &pairs, Mixing mixing)
{
  std::string text = "mix ";
  text.append(mixing_names[std::size_t(mixing)]);
  for (const PairMaterial &pair : pairs) text.append("\n" + pair.types + " " + written(pair.own));
  return text;
}

void take_told(Settings &settings, const std::string &told)
{
  std::istringstream text(told);
  std::string line;
  std::getline(text, line);
  std::istringstream first(line);
  settings.mixing = read_mixing(first);
  settings.pairs.clear();
  while (std::getline(text, line)) {
    std::istringstream one(line);
    settings.pairs.push_back(read_pair(one));
  }
}

void require_no_pairs(const Settings &settings, const std::string &keyword)
{
  if (!settings.pairs.empty())
    fail("materials of types of atoms are given to pair style nscd: use `pair_coeff ", settings.pairs[0].types, " ",
         written(settings.pairs[0].own), "` in place of ", keyword);
}

}    // namespace nscd
