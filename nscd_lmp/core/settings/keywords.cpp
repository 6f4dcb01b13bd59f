// SPDX-License-Identifier: GPL-2.0-or-later
// fix nscd's keywords: from words to Settings.
#include "base/error.hpp"
#include "settings/settings.hpp"

#include <charconv>
#include <functional>
#include <map>
#include <set>

namespace nscd {

namespace {

// Hands out the words one by one; knows for which keyword a value is missing or malformed.
class Words {
 public:
  explicit Words(const std::vector<std::string> &words) : words_(words) {}
  bool done() const { return next_ == words_.size(); }
  // Takes the next word if it is this one.
  bool skip(const std::string &word)
  {
    const bool there = !done() && words_[next_] == word;
    if (there) keyword_ += " " + words_[next_++];
    return there;
  }
  const std::string &keyword() { return keyword_ = words_[next_++]; }

  const std::string &word()
  {
    if (done()) fail("keyword ", keyword_, " needs a value");
    return words_[next_++];
  }

  template <class Number>
  Number number(const char *wanted = std::is_integral_v<Number> ? "a whole number" : "a number")
  {
    const std::string &text = word();
    Number value{};
    const char *first = text.data(), *const last = first + text.size();
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // which LAMMPS takes, and from_chars not
    const auto [end, problem] = std::from_chars(first + plus, last, value);
    if (problem != std::errc() || end != last)
      fail("keyword ", keyword_, ": '", text, "' is not ", wanted);
    return value;
  }

  bool yes_or_no()
  {
    const std::string &text = word();
    if (text == "yes" || text == "on" || text == "true") return true;
    if (text == "no" || text == "off" || text == "false") return false;
    fail("keyword ", keyword_, ": '", text, "' is neither yes nor no");
  }

 private:
  const std::vector<std::string> &words_;
  std::size_t next_ = 0;
  std::string keyword_;
};

double read_friction(Words &words)
{
  return words.skip("stick") ? stick : words.number<double>("a number, nor stick");
}

Inertia read_inertia(Words &words)
{
  const std::string &word = words.word();
  if (word == "sphere") return Inertia::sphere;
  if (word == "disc") return Inertia::disc;
  fail("unknown inertia '", word, "': choose one of sphere, disc");
}

// A friction right behind a wall is the wall's own.
Plane read_wall(Words &words)
{
  const std::string &kind = words.word();
  if (kind != "plane") fail("unknown wall '", kind, "': choose plane");
  Plane plane{};
  for (double &value : plane.point) value = words.number<double>();
  for (double &value : plane.normal) value = words.number<double>();
  if (words.skip("friction")) plane.friction = read_friction(words);
  else if (words.skip("stick")) plane.friction = stick;
  return plane;
}

using Reader = std::function<void(Settings &, Words &)>;

const std::map<std::string, Reader> &readers()
{
  static const std::map<std::string, Reader> list{
      {"solver", [](Settings &s, Words &w) { s.solver = w.word(); }},
      {"law", [](Settings &s, Words &w) { s.law = w.word(); }},
      {"restitution", [](Settings &s, Words &w) { s.restitution = w.number<double>(); }},
      {"friction", [](Settings &s, Words &w) { s.friction = read_friction(w); }},
      {"stick", [](Settings &s, Words &) { s.friction = stick; }},
      {"e_t", [](Settings &s, Words &w) { s.e_t = w.number<double>(); }},
      {"inertia", [](Settings &s, Words &w) { s.inertia = read_inertia(w); }},
      {"tol", [](Settings &s, Words &w) { s.tol = w.number<double>(); }},
      {"accuracy", [](Settings &s, Words &w) { s.accuracy = parse_accuracy(w.word()); }},
      {"criterion", [](Settings &s, Words &w) { s.criterion = parse_stop(w.word()); }},
      {"maxiter", [](Settings &s, Words &w) { s.maxiter = w.number<int>(); }},
      {"budget", [](Settings &s, Words &w) { s.budget = w.number<int>(); }},
      {"warmstart", [](Settings &s, Words &w) { s.warmstart = w.yes_or_no(); }},
      {"rho", [](Settings &s, Words &w) { s.rho = w.number<double>(); }},
      {"gamma", [](Settings &s, Words &w) { s.gamma = w.number<double>(); }},
      {"overlap", [](Settings &s, Words &w) { s.overlap = w.number<double>(); }},
      {"paper", [](Settings &s, Words &w) { if (w.yes_or_no()) follow_paper(s); }},
      {"theta", [](Settings &s, Words &w) { s.theta = w.number<double>(); }},
      {"recovery", [](Settings &s, Words &w) { s.recovery = w.number<double>(); }},
      {"threads", [](Settings &s, Words &w) { s.threads = w.number<int>(); }},
      {"wall", [](Settings &s, Words &w) { s.walls.push_back(read_wall(w)); }},
      {"unconverged", [](Settings &s, Words &w) { s.unconverged = parse_unconverged(w.word()); }},
  };
  return list;
}

// What `paper yes` sets.
const std::set<std::string> of_paper{"solver", "law", "criterion", "tol", "warmstart"};

// Refuses a keyword whose place makes it mean something else than it seems to; `given` are those before it, `last` the
// one right before it.
void refuse_misplaced(const std::string &keyword, const std::string &last, const std::set<std::string> &given)
{
  if (keyword != "wall" && given.count(keyword == "stick" ? "friction" : keyword))
    fail("keyword ", keyword, keyword == "stick" ? " is a friction, which" : "", " is given twice: give it once");
  if (last == "wall" && (keyword == "restitution" || keyword == "e_t"))
    fail("keyword ", keyword, " right behind a wall would be that of all contacts: a wall has a friction of its own, "
         "but no ", keyword, ". Give it before the walls");
  if (last == "wall" && (keyword == "friction" || keyword == "stick"))
    fail("the wall has its friction already, and keyword ", keyword, " behind it would be that of the pairs: give that "
         "before the walls");
  if (keyword != "paper") return;
  for (const std::string &other : of_paper)
    if (given.count(other)) fail("keyword paper behind ", other, " would override it: give paper first");
}

}    // namespace

void parse_keywords(Settings &settings, const std::vector<std::string> &words)
{
  Words rest(words);
  std::set<std::string> given;
  std::string last;
  while (!rest.done()) {
    const std::string keyword = rest.keyword();
    const auto reader = readers().find(keyword);
    if (reader == readers().end()) {
      std::string choices;
      for (const auto &[known, unused] : readers()) choices += (choices.empty() ? "" : ", ") + known;
      fail("unknown keyword '", keyword, "': choose one of ", choices);
    }
    refuse_misplaced(keyword, last, given);
    reader->second(settings, rest);
    given.insert(keyword == "stick" ? "friction" : keyword);
    last = keyword;
  }
}

}    // namespace nscd
