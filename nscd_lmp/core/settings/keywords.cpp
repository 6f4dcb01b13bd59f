// SPDX-License-Identifier: GPL-2.0-or-later
// The table of fix nscd's keywords. In the texts *word* is a keyword or a value of one.
#include "obstacle/kinds.hpp"
#include "parallel/team.hpp"
#include "settings/schemes.hpp"
#include "settings/values.hpp"
#include "settings/wall_options.hpp"

namespace nscd {

namespace {

using namespace values;

constexpr double largest = std::numeric_limits<double>::max();
constexpr Limits share{.lo = 0, .hi = 1}, positive{.lo = 0, .hi = largest, .lo_is_in = false};
constexpr std::string_view start_with_default = ": it is a multiple of 1/W_nn, and the default is a good start";

// Where a value is in settings.
template <class T>
auto at(T Settings::*member)
{
  return [member](auto &settings) -> auto & { return settings.*member; };
}
auto at(double Material::*part)
{
  return [part](auto &settings) -> auto & { return settings.material.*part; };
}

void read_own_numbers(OwnMaterial &own, Arguments &words)
{
  while (read_own_part(own, words)) {}
}

void read_wall(Settings &settings, Arguments &words)
{
  std::string name = "wall ";
  name += std::to_string(settings.walls.size() + 1);
  const auto shape = find_obstacle_kind(words.word()).read(words, name);
  WallOptions options(name);
  while (options.read(words)) {}
  settings.walls.push_back(options.wall(shape));
}

// All kinds of walls with their words; kin of one kind have its text.
std::string_view told_walls()
{
  static const std::string text = [] {
    std::string all;
    std::string_view between = "";
    for (const ObstacleEntry &kind : obstacle_kinds()) {
      all.append(between).append("*").append(kind.name).append("* ").append(kind.words);
      between = kind.doc.empty() ? ", " : "; ";
      if (!kind.doc.empty()) all.append(": ").append(kind.doc);
    }
    return all + "; then what its contacts have of their own, as behind *material*; walls that move: " +
        "[fix wall/nscd](wall_nscd.md)";
  }();
  return text;
}

TypeRange read_types(const std::string &text)
{
  const std::string_view all = text;
  const std::size_t star = all.find('*');
  TypeRange range;
  const auto read = [&](std::string_view part, int &type) {
    if (!Arguments::read(part, type) || type < 1)
      fail("keyword material: '", text, "' names no types of atoms: give a number from 1, or a range as 2*4, 2* or *");
  };
  if (star == all.npos) {
    read(all, range.first);
    range.last = range.first;
    return range;
  }
  if (star > 0) read(all.substr(0, star), range.first);
  if (star + 1 < all.size()) read(all.substr(star + 1), range.last);
  if (range.last != 0 && range.last < range.first) fail("keyword material: the range '", text, "' has no types in it");
  return range;
}

void read_pair(Settings &settings, Arguments &words)
{
  const std::string first = words.word(), second = words.word();
  PairMaterial pair{first + " " + second, read_types(first), read_types(second), {}};
  read_own_numbers(pair.own, words);
  for (std::size_t part = 0; part < material_parts.size(); ++part)
    if (pair.own.has(part)) return settings.pairs.push_back(pair);
  fail("material ", pair.types, ": behind the two types stand friction, restitution or e_t, with their numbers");
}

std::vector<Keyword> table()
{
  return {
      {.name = "solver",
       .value = name_of(solvers, at(&Settings::solver)),
       .doc = "*sbp*, *sal*, *ebp*, *eal* or *pdas*: the local law inside nonlinear Gauss-Seidel; *apgs*, the same "
              "with momentum; *active_set*, sparse factorisations, without friction only; *interior_point*, the same "
              "with friction; *auto*: [solvers.md](solvers.md)",
       .described = true},
      {.name = "law",
       .value = name_of(schemes, at(&Settings::law)),
       .doc = "*moreau* or *gap*: the contact law",
       .described = true},
      {.name = "restitution",
       .value = number(at(&Material::restitution)),
       .range = share,
       .doc = "Newton's coefficient e of contacts without their own",
       .described = true},
      {.name = "friction",
       .value = friction(at(&Material::friction)),
       .range = {.lo = 0},
       .reason = ", or `stick` for contacts that do not slip",
       .doc = "Coulomb's coefficient mu of contacts without their own, or *stick*: no slip while in contact; where no "
              "contact has any, grains have no spins",
       .described = true},
      {.name = "stick",
       .value = {.kind = "", .read = [](Settings &s, Arguments &) { s.material.friction = stick; }},
       .doc = "",
       .described = true},
      {.name = "e_t",
       .value = number(at(&Material::e_t)),
       .range = share,
       .doc = "tangential restitution of contacts without their own; with friction only",
       .described = true},
      {.name = "min_bounce",
       .value = number(at(&Settings::min_bounce)),
       .range = {.lo = 0},
       .doc = "of law *gap* with restitution: pairs that meet slower than this velocity do not bounce. Dense beds, "
              "where grains meet slowly without end, are solved faster with it. A grain that drops from a height h "
              "meets with sqrt(2 g h)"},
      {.name = "material",
       .value = {.kind = "I J and its numbers", .read = read_pair, .repeats = true},
       .otherwise = "none",
       .doc = "types I and J of atoms (or ranges, as 2\\*4, 2\\* or \\*), then what their contacts have of their own: "
              "*friction* mu, *friction stick* or *stick*, *restitution* e, *e_t* e_t; of several that name a pair the "
              "later ones hold",
       .described = true},
      {.name = "wall",
       .value = {.kind = "a kind of wall and its numbers", .read = read_wall, .repeats = true},
       .otherwise = "no walls",
       .doc = told_walls(),
       .described = true},
      {.name = "inertia",
       .value = choice("inertia", {"sphere", "disc"}, at(&Settings::inertia)),
       .otherwise = "*sphere*, in dimension 2 *disc*",
       .doc = "*sphere* (2/5 m r^2), or *disc* (1/2 m r^2) in `dimension 2`; with friction only",
       .described = true},
      {.name = "accuracy",
       .value = choice("accuracy", {"loose", "normal", "tight"}, at(&Settings::accuracy)),
       .otherwise = "*normal*",
       .doc = "*loose*, *normal* or *tight*: how good steps are where *tol*, *overlap* and *budget* are not given, "
              "with *criterion natural*: 1e-2, 1e-3 and 10; 1e-3, 5e-4 and 30; 1e-4, 1e-4 and 300. *loose* is for "
              "grains that fall and flow, *tight* for beds that must stand still "
              "([what each buys](friction_accuracy.md))"},
      {.name = "tol",
       .value = number(at(&Settings::tol)),
       .range = positive,
       .reason = ": it is the value of the criterion at which a step is solved",
       .otherwise = "1e-3; with *criterion paper* 1e-7",
       .doc = "value of the criterion below which a step is solved: of the scene's own velocities with *criterion "
              "natural*, in velocity units with *criterion paper*",
       .described = true},
      {.name = "criterion",
       .value = choice("criterion", {"paper", "natural"}, at(&Settings::criterion)),
       .otherwise = "*natural*",
       .doc = "what *tol* is compared with. *criterion paper*: (42) of Barboteu & Dumont (2017), the mean over the "
              "contacts, f_ID[3]; *criterion natural*: the natural map of all contacts over the norm of their "
              "velocities without impulses, f_ID[7]",
       .described = true},
      {.name = "overlap",
       .value = number(at(&Settings::overlap)),
       .range = {.lo = 0, .hi = 1, .lo_is_in = false},
       .reason = ": it is a share of the smaller radius of a contact",
       .otherwise = "5e-4 with *criterion natural*, no such condition with *criterion paper*",
       .doc = "of law *gap*: a step is solved only when no contact is driven deeper than this share of its own smaller "
              "radius",
       .described = true},
      {.name = "budget",
       .value = number(at(&Settings::budget)),
       .range = {.lo = 0},
       .reason = ": sweeps after which a step may be accepted, 0 for never",
       .otherwise = "30 with friction and *criterion natural* (below 2000 contacts more: 60,000 visits of contacts), "
                    "else 0",
       .doc = "sweeps after which, or at *maxiter* if that is less, a step above *tol* is accepted if it is below 30 "
              "*tol* and within *overlap*, f_ID[14]; 0: never"},
      {.name = "maxiter",
       .value = number(at(&Settings::maxiter)),
       .range = {.lo = 1},
       .doc = "iterations of a solve after which it is given up"},
      {.name = "warmstart",
       .value = yes_or_no(at(&Settings::warmstart)),
       .doc = "*yes* or *no*: start from the impulses of the last step"},
      {.name = "paper",
       .value = {.kind = "yes or no",
                 .read = [](Settings &s, Arguments &w) { if (w.yes_or_no()) follow_paper(s); }},
       .otherwise = "*no*",
       .doc = "*yes*: the settings of Barboteu & Dumont (2017), which later keywords override (so it comes first): "
              "*solver pdas law moreau criterion paper tol 1e-7 warmstart no*"},
      {.name = "rho",
       .value = number(at(&Settings::rho)),
       .range = positive,
       .reason = start_with_default,
       .otherwise = "4/9 (*sbp*, *sal*), 1 (*ebp*, *eal*)",
       .doc = "parameter of *sbp*, *sal*, *ebp*, *eal*, a multiple of 1/W_nn",
       .described = true},
      {.name = "gamma",
       .value = number(at(&Settings::gamma)),
       .range = positive,
       .reason = start_with_default,
       .otherwise = "1",
       .doc = "parameter of *pdas*, a multiple of 1/W_nn and, with friction, of 1/W_tt",
       .described = true},
      {.name = "theta",
       .value = number(at(&Settings::theta)),
       .range = share,
       .doc = "of law *moreau*: contacts are sought at q + (1 - theta) dt v"},
      {.name = "recovery",
       .value = number(at(&Settings::recovery)),
       .range = share,
       .doc = "of law *gap*: share of an overlap given back per step (with friction of what is beyond 3e-5 of the "
              "smaller radius)"},
      {.name = "unconverged",
       .value = choice("unconverged", {"ignore", "warn", "error"}, at(&Settings::unconverged)),
       .doc = "*ignore*, *warn* or *error*: what to do about steps that are given up, say nothing, warn at the end of "
              "a run, or stop it"},
      {.name = "threads",
       .value = number(at(&Settings::threads)),
       .range = {.lo = 1, .hi = most_threads},
       .reason = ": they are of each rank, and share its contacts",
       .doc = "threads of each rank that share its contacts: [ranks.md](ranks.md#threads)",
       .described = true},
  };
}

}    // namespace

const std::vector<Keyword> &keywords()
{
  static const std::vector<Keyword> all = table();
  return all;
}

std::string default_of(const Keyword &keyword)
{
  if (!keyword.otherwise.empty() || !keyword.value.write) return std::string(keyword.otherwise);
  const std::string value = keyword.value.write(Settings{});
  return keyword.value.number ? value : "*" + value + "*";
}

std::string Limits::text() const
{
  constexpr double all = std::numeric_limits<double>::max();
  const std::string from = values::written(lo);
  if (lo < -all) return "";
  if (hi < all) return from + " to " + values::written(hi) + (lo_is_in ? "" : ", not " + from);
  return (lo_is_in ? ">= " : "> ") + from;
}

}    // namespace nscd
