// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/report.hpp"

#include "scene/gap.hpp"
#include "scene/slides.hpp"
#include "settings/keyword.hpp"

#include <algorithm>
#include <sstream>

namespace nscd {

double report_column(const StepReport &r, int column)
{
  switch (column) {
    case 0: return double(r.contacts);
    case 1: return r.iterations;
    case 2: return r.criterion.total();
    case 3: return r.criterion.motion;
    case 4: return r.criterion.bipotential;
    case 5: return r.criterion.penetration;
    case 6: return r.criterion.relative;
    case 7: return r.largest_overlap;
    case 8: return r.dissipated;
    case 9: return r.largest_overlap_ratio;
    case 10: return double(r.unconverged);
    case 11: return double(r.energy_limited);
    case 12: return r.criterion.worst;
    case 13: return double(r.accepted_steps);
  }
  return 0;
}

int contact_columns(const Settings &settings)
{
  return int(contact_column_names.size()) - (settings.frictional() ? 0 : tangential_columns);
}

void fill_contact_rows(const State &s, double *row, int columns)
{
  std::fill_n(row, s.table.contacts.size() * std::size_t(columns), 0.0);
  const double per_force = s.in.grains.force_to_acceleration;   // impulses are mass times velocity within
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k, row += columns) {
    const Contact &c = s.table.contacts[k];
    const ContactInfo &info = s.table.infos[k];
    const Sphere a = in_arrays(s, info.atom_i);
    const Vec4 point = a.centre - c.normal * (a.radius + 0.5 * info.gap);
    row[0] = s.in.grains.tag[info.atom_i];
    row[1] = info.atom_j >= 0 ? s.in.grains.tag[info.atom_j] : -1 - wall_of(info.atom_j);
    for (int d = 0; d < 3; ++d) {
      row[2 + d] = point[d];
      row[5 + d] = c.normal[d];
    }
    row[8] = info.gap;
    row[9] = c.impulse / per_force;
    if (s.friction.model == Model::frictionless) continue;
    const Vec4 tangential = tangential_impulse(s, k);
    for (int d = 0; d < 3; ++d) row[10 + d] = tangential[d] / per_force;
  }
}

static std::string describe_solver(const Settings &s)
{
  const SolverEntry &solver = find_solver(s.solver);
  std::ostringstream text;
  if (solver.kind != "local law") return std::string(solver.title);
  text << "NLGS with " << solver.title << " (" << solver.parameter << " = " << solver_parameter(s, solver) << "/W_nn)";
  return text.str();
}

// What contacts have of a part of their material: those without their own, pairs of types, walls.
static std::string of_contacts(const Settings &s, std::string_view name)
{
  const auto named = [&](const MaterialPart &part) { return part.name == name; };
  const std::size_t part = std::size_t(std::find_if(material_parts.begin(), material_parts.end(), named) -
                                       material_parts.begin());
  std::ostringstream text;
  const auto add = [&](double value) -> std::ostream & { return value == stick ? text << "stick" : text << value; };
  add(s.material.*material_parts[part].value);
  for (const PairMaterial &pair : s.pairs)
    if (pair.own.has(part)) text << ", ", add(pair.own.value(part)) << " of types " << pair.types;
  const auto has = [part](const PairMaterial &pair) { return pair.own.has(part); };
  if (s.mixing != Mixing::none && std::any_of(s.pairs.begin(), s.pairs.end(), has))
    text << (s.mixing == Mixing::geometric ? ", geometric" : ", arithmetic")
         << " means of types that pair_coeff leaves out";
  for (const Wall &wall : s.walls)
    if (wall.own.has(part)) text << ", ", add(wall.own.value(part)) << " on " << wall.name;
  return text.str();
}

static std::string describe_model(const Settings &s, const Friction &friction)
{
  if (friction.model == Model::frictionless) return "frictionless: 1 unknown per contact, no spins";
  const std::string unknowns = friction.model == Model::planar ? "; planar: 2 unknowns per contact, spins about z"
                                                               : "; spatial: 3 unknowns per contact, spins";
  return "friction " + of_contacts(s, "friction") + unknowns +
      (friction.spin_response == disc_spin_response ? " of discs" : " of spheres");
}

static std::string describe_restitution(const Settings &s)
{
  if (!s.restitutive()) return "no restitution term";
  const std::string text = "impacts with restitution " + of_contacts(s, "restitution");
  return s.frictional() ? text + ", tangential " + of_contacts(s, "e_t") : text;
}

// Keywords that have no words above and are not what they are by default, as a script gives them.
static std::string describe_others(const Settings &s)
{
  std::string text;
  for (const Keyword &keyword : keywords()) {
    if (keyword.described || !keyword.value.write) continue;
    const std::string value = keyword.value.write(s);
    if (!value.empty() && value != keyword.value.write({})) text += "; " + std::string(keyword.name) + " " + value;
  }
  return text;
}

static std::string describe_ranks(const Halo *halo, int threads)
{
  const std::string team = threads > 1 ? std::to_string(threads) + " threads" : "";
  if (!halo) return team.empty() ? "one rank: no exchange" : "one rank, " + team + ": no exchange";
  return std::to_string(halo->ranks().count()) + (team.empty() ? " ranks" : " ranks, " + team + " each") +
         ": grains that several ranks touch are exchanged every iteration";
}

static std::string describe_overlap(const Settings &s)
{
  std::ostringstream text;
  if (s.overlap) text << ", overlap " << *s.overlap;
  return text.str();
}

std::string describe(const Step &step)
{
  const Settings &s = step.settings();
  std::ostringstream text;
  text << "law " << s.law << ", " << (step.has_custom_solver() ? "a solver handed in" : describe_solver(s)) << ", tol "
       << *s.tol << (s.criterion == Stop::natural ? " (natural map)" : " (criterion paper)") << describe_overlap(s)
       << ", " << s.walls.size()
       << (s.walls.size() == 1 ? " wall" : " walls")
       << "; " << describe_model(s, step.state().friction) << "; " << describe_restitution(s)
       << describe_others(s) << "; " << describe_ranks(step.halo(), s.threads);
  return text.str();
}

}    // namespace nscd
