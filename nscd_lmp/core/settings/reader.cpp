// SPDX-License-Identifier: GPL-2.0-or-later
// From the words of a script to Settings.
#include "settings/keyword.hpp"

#include <algorithm>
#include <set>

namespace nscd {

namespace {

// What `paper yes` sets.
const std::set<std::string> of_paper{"solver", "law", "criterion", "tol", "warmstart"};

// Two keywords that set one value have one name here.
std::string setting_of(const std::string &keyword) { return keyword == "stick" ? "friction" : keyword; }

bool is_of_material(const std::string &keyword)
{
  const auto names = [&](const MaterialPart &part) { return part.name == setting_of(keyword); };
  return std::any_of(material_parts.begin(), material_parts.end(), names);
}

// Refuses a keyword whose place makes it mean something else than it seems to; `given` are those before it.
void refuse_misplaced(const std::string &keyword, const std::set<std::string> &given)
{
  if (!find_keyword(keyword).value.repeats && given.count(setting_of(keyword)))
    fail("keyword ", keyword, keyword == "stick" ? " is a friction, which" : "", " is given twice: give it once");
  if ((given.count("wall") || given.count("material")) && is_of_material(keyword))
    fail("keyword ", keyword, " here would be the ", setting_of(keyword), " of all contacts without their own: give ",
         "that before walls and materials, and what a wall or a material has of its own right behind it, once");
  if (keyword != "paper") return;
  for (const std::string &other : of_paper)
    if (given.count(other)) fail("keyword paper behind ", other, " would override it: give paper first");
}

}    // namespace

const Keyword &find_keyword(std::string_view name)
{
  std::string choices;
  for (const Keyword &keyword : keywords()) {
    if (keyword.name == name) return keyword;
    choices.append(choices.empty() ? "" : ", ").append(keyword.name);
  }
  fail("unknown keyword '", name, "': choose one of ", choices);
}

void parse_keywords(Settings &settings, const std::vector<std::string> &words)
{
  Arguments rest(words);
  std::set<std::string> given;
  while (!rest.done()) {
    const std::string name = rest.keyword();
    const Keyword &keyword = find_keyword(name);
    refuse_misplaced(name, given);
    keyword.value.read(settings, rest);
    given.insert(setting_of(name));
  }
}

}    // namespace nscd
