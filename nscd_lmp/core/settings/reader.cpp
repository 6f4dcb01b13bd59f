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

// Refuses a keyword whose place makes it mean something else than it seems to; `given` are those before it, `last` the
// one right before it.
void refuse_misplaced(const std::string &keyword, const std::string &last, const std::set<std::string> &given)
{
  if (!find_keyword(keyword).value.repeats && given.count(setting_of(keyword)))
    fail("keyword ", keyword, keyword == "stick" ? " is a friction, which" : "", " is given twice: give it once");
  if ((last == "wall" || last == "material") && is_of_material(keyword))
    fail("the ", last, " has its ", setting_of(keyword), " already, and keyword ", keyword, " behind it would be that ",
         "of all other contacts: give that before walls and materials");
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
  std::string last;
  while (!rest.done()) {
    const std::string name = rest.keyword();
    const Keyword &keyword = find_keyword(name);
    refuse_misplaced(name, last, given);
    keyword.value.read(settings, rest);
    given.insert(setting_of(name));
    last = name;
  }
}

}    // namespace nscd
