// SPDX-License-Identifier: GPL-2.0-or-later
// What contacts have of their own, from the words of a script and back.
#include "settings/values.hpp"

namespace nscd {

namespace {

std::string told_parts()
{
  std::string all;
  for (const MaterialPart &part : material_parts) all.append(all.empty() ? "" : ", ").append(part.name);
  return all;
}

}    // namespace

bool read_own_part(OwnMaterial &own, Arguments &words)
{
  constexpr std::string_view friction_name = material_parts[0].name;
  for (std::size_t part = 0; part < material_parts.size(); ++part) {
    if (own.has(part)) continue;
    const bool is_friction = material_parts[part].name == friction_name;
    if (is_friction && words.skip("stick")) own.set(part, stick);
    else if (words.skip(material_parts[part].name))
      own.set(part, is_friction ? values::read_friction(words) : words.number<double>());
    if (own.has(part)) return true;
  }
  return false;
}

OwnMaterial read_own_material(const std::vector<std::string> &words)
{
  std::vector<std::string> named{"pair_coeff"};   // as what errors name the numbers
  named.insert(named.end(), words.begin(), words.end());
  OwnMaterial own;
  Arguments rest(named);
  rest.keyword();
  while (read_own_part(own, rest)) {}
  if (rest.done()) return own;
  refuse_own_word(rest.keyword(), told_parts());
}

void refuse_own_word(const std::string &word, const std::string &choices)
{
  for (std::size_t part = 0; part < material_parts.size(); ++part)
    if (word == material_parts[part].name || (word == "stick" && part == 0))
      fail(word, " is given twice: give it once");
  fail("unknown keyword '", word, "': choose one of ", choices);
}

std::string written(const OwnMaterial &own)
{
  std::string text;
  for (std::size_t part = 0; part < material_parts.size(); ++part) {
    if (!own.has(part)) continue;
    text.append(text.empty() ? "" : " ").append(material_parts[part].name);
    text.append(" ").append(values::written_friction(own.value(part)));
  }
  return text;
}

}    // namespace nscd
